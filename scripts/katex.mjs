// A preprocessor of mdBook: equations between $ and $$ become MathML, which browsers draw without scripts or fonts of ours.
// Called by mdBook as docs/book.toml says; scripts/book tells where KaTeX is. Code keeps its dollars.
import { createRequire } from "node:module";
import { readFileSync } from "node:fs";

if (process.argv[2] === "supports") process.exit(process.argv[3] === "html" ? 0 : 1);

const katex = createRequire(`${process.env.BRISANCE_BOOK_TOOLS}/`)("katex");
const PARTS = /(^```[\s\S]*?^```|`+[^`]*`+)|\$\$([\s\S]+?)\$\$|\$([^$\n]+?)\$/gm;

// First letters, large and small, of the alphabets that browsers know by character and not by attribute.
const ALPHABETS = { bold: [0x1d400, 0x1d41a], "sans-serif": [0x1d5a0, 0x1d5ba], monospace: [0x1d670, 0x1d68a] };

function lettered(all, variant, text) {
    const [large, small] = ALPHABETS[variant] ?? [];
    if (large === undefined) return all;
    const letter = (c) => String.fromCodePoint(c < "a" ? large + c.charCodeAt(0) - 65 : small + c.charCodeAt(0) - 97);
    return `<mi>${text.replace(/[A-Za-z]/g, letter)}</mi>`;
}

function rendered(name, source, displayMode) {
    try {
        const text = katex.renderToString(source.trim(), { displayMode, output: "mathml", strict: "error" });
        // Without the source that KaTeX repeats, and with nothing in it that Markdown would read.
        const plain = text.replace(/<annotation.*?<\/annotation>/s, "").replaceAll("\n", " ");
        const known = plain.replace(/<mi mathvariant="([a-z-]+)">([^<]*)<\/mi>/g, lettered);
        return known.replace(/[*_`|[\]\\]/g, (sign) => `&#${sign.charCodeAt(0)};`);
    } catch (error) {
        throw new Error(`${name}: ${source.trim()}: ${error.message}`);
    }
}

function visit(items) {
    for (const { Chapter: chapter } of items.filter((item) => item.Chapter)) {
        chapter.content = chapter.content.replace(PARTS, (all, code, display, inline) =>
            code ? all : rendered(chapter.path, display ?? inline, display !== undefined));
        visit(chapter.sub_items);
    }
}

const [, book] = JSON.parse(readFileSync(0, "utf8"));
visit(book.items);
process.stdout.write(JSON.stringify(book));
