// SPDX-License-Identifier: Apache-2.0
// Has tinyusdz (npm, version 0.9.0-rc10 tried), a parser of USD that is not ours, read stages.
//
//     node parse_usda.mjs FOLDER_OF_TINYUSDZ FILE...
//
// Exit status: 0 when it accepts all files and refuses a spoilt version of each, 1 when not,
// 77 when the package is not there.
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { pathToFileURL } from 'node:url';

const [folder, ...files] = process.argv.slice(2);
const module_file = path.join(folder ?? '', 'tinyusdz.js');
if (!fs.existsSync(module_file)) {
    console.log(`tinyusdz is not in ${folder}`);
    process.exit(77);
}

// The package is compiled for browsers: it looks for a window, and has no module extension.
process.type = 'renderer';
globalThis.window = globalThis;
const copy = path.join(fs.mkdtempSync(path.join(os.tmpdir(), 'tinyusdz-')), 'tinyusdz.mjs');
fs.copyFileSync(module_file, copy);
const { default: start } = await import(pathToFileURL(copy));
const usd = await start({ wasmBinary: fs.readFileSync(path.join(folder, 'tinyusdz.wasm')) });
fs.rmSync(path.dirname(copy), { recursive: true });

function parse(text, name) {
    const loader = new usd.TinyUSDZLoaderNative();
    const read = loader.loadAsLayerFromBinary(new TextEncoder().encode(text), name);
    return read ? '' : loader.error() || 'refused without a reason';
}

let good = true;
for (const file of files) {
    const text = fs.readFileSync(file, 'utf8');
    const error = parse(text, path.basename(file));
    // Three numbers where four belong, and a string without its end.
    const spoilt = [text.replace(/(tetVertexIndices = \[\()\d+, /, '$1'), text.replace('"Y"', '"Y')];
    const missed = spoilt.filter((one) => one !== text && !parse(one, 'spoilt.usda')).length;
    console.log(`${path.basename(file)}: ${error ? 'FAILED: ' + error : 'accepted'}; spoilt versions accepted: ${missed}`);
    good = good && !error && missed === 0;
}
process.exit(good ? 0 : 1);
