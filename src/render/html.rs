//! What pages are made of: their looks, and text that cannot break them.

/// Looks of the page, also on paper.
pub(crate) const PAGE_STYLE: &str = "body{font:15px/1.45 system-ui,sans-serif;color:#111;background:#fff;max-width:78rem;margin:2rem auto;padding:0 1rem}\
h1{font-size:1.6rem}h2{margin-top:2.2rem;border-bottom:1px solid #999}h3{margin-bottom:.2rem}\
table{border-collapse:collapse;width:100%;font-size:.8rem;margin:.6rem 0}th,td{border-bottom:1px solid #ddd;padding:.15rem .5rem;\
text-align:left;vertical-align:top}th{background:#f2f2f2}.good{color:#00591f;font-weight:600}.pass{color:#00591f}\
.known{color:#7a4b00;font-weight:600}\
.fail{color:#fff;background:#b00020;font-weight:700}.plots{display:flex;flex-wrap:wrap;gap:.6rem}.plots svg{width:36rem;max-width:100%}\
@media print{body{font-size:9pt;margin:0;max-width:none}.plots svg{width:48%}h2,h3{break-after:avoid}tr,svg{break-inside:avoid}\
th{background:none;border-bottom:1px solid #000}.fail{color:#000;background:none;border:2px solid #000}}";

/// Text for HTML and SVG.
pub(crate) fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
