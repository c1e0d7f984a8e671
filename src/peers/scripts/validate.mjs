// What the Khronos validator says of glTF files: errors, warnings, infos of each; exit code 1 on an error or a warning.
//
//     npm install gltf-validator
//     node src/peers/scripts/validate.mjs FILE.glb...
//
// Run it where `npm install` was run, or name that folder in NODE_PATH.
import { createRequire } from "node:module";
import { readFileSync } from "node:fs";
import { basename, dirname, join } from "node:path";

const require = createRequire(join(process.cwd(), "here.js"));
const { validateBytes, version } = require("gltf-validator");

console.log(`gltf-validator ${version()}`);
let clean = true;
for (const file of process.argv.slice(2)) {
  const report = await validateBytes(new Uint8Array(readFileSync(file)), {
    uri: basename(file),
    maxIssues: 0,
    externalResourceFunction: async (uri) => new Uint8Array(readFileSync(join(dirname(file), decodeURIComponent(uri)))),
  });
  const { numErrors, numWarnings, numInfos, numHints, messages } = report.issues;
  console.log(`${basename(file)}: ${numErrors} errors, ${numWarnings} warnings, ${numInfos} infos, ${numHints} hints`);
  const codes = new Map();
  for (const { code, severity, pointer, message } of messages) {
    const seen = codes.get(code) ?? { count: 0, severity, pointer, message };
    codes.set(code, { ...seen, count: seen.count + 1 });
  }
  for (const [code, { count, severity, pointer, message }] of codes) {
    console.log(`  ${["error", "warning", "info", "hint"][severity]} ${code} x ${count}, first at ${pointer}: ${message}`);
  }
  clean &&= numErrors + numWarnings === 0;
}
process.exitCode = clean ? 0 : 1;
