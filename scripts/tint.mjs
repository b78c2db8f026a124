// Compiles every kernel of a folder with Dawn's null backend: Tint, and the validation of WebGPU at its default limits.
// Usage: node scripts/tint.mjs TOOLS FOLDER
import { readdirSync, readFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const [tools, folder] = process.argv.slice(2);
const { create, globals } = await import(pathToFileURL(join(tools, "node_modules/webgpu/index.js")));
Object.assign(globalThis, globals);

const gpu = create(["backend=null"]);
const adapter = await gpu.requestAdapter();
const device = await adapter.requestDevice();
const start = Date.now();
const failures = [];
const modules = new Map();

async function moduleOf(text) {
    if (modules.has(text)) return modules.get(text);
    device.pushErrorScope("validation");
    const module = device.createShaderModule({ code: readFileSync(join(folder, text), "utf8") });
    const info = await module.getCompilationInfo();
    const errors = info.messages.filter((message) => message.type === "error");
    const scope = await device.popErrorScope();
    for (const error of errors) failures.push(`${text}:${error.lineNum}:${error.linePos}: ${error.message}`);
    const good = errors.length === 0 && scope === null;
    if (scope !== null && errors.length === 0) failures.push(`${text}: ${scope.message}`);
    modules.set(text, good ? module : null);
    return modules.get(text);
}

const kernels = readdirSync(folder).filter((name) => name.endsWith(".json"));
for (const name of kernels) {
    const kernel = JSON.parse(readFileSync(join(folder, name), "utf8"));
    const module = await moduleOf(kernel.text);
    if (module === null) continue;
    device.pushErrorScope("validation");
    const entries = kernel.bindings.map((binding) => ({
        binding: binding.binding,
        visibility: 4, // GPUShaderStage.COMPUTE
        buffer: { type: binding.type, minBindingSize: binding.min_bytes },
    }));
    const layout = device.createPipelineLayout({ bindGroupLayouts: [device.createBindGroupLayout({ entries })] });
    device.createComputePipeline({ layout, compute: { module, entryPoint: kernel.entry, constants: kernel.overrides } });
    const error = await device.popErrorScope();
    if (error !== null) failures.push(`${name}: ${error.message}`);
}
for (const failure of failures) console.error(failure);
const seconds = ((Date.now() - start) / 1000).toFixed(1);
console.log(`tint: ${modules.size} modules, ${kernels.length} pipelines, ${failures.length} failures, ${seconds} s`);
// Dawn's node module keeps the process alive.
process.exit(failures.length > 0 || kernels.length === 0 ? 1 : 0);
