// Bundles the page's scripts into `built`. The folder is committed, so tissuebench builds and runs without
// node.
//
// The first line of each script has a hash of the sources, which a test of the crate compares without node.
// `--check` bundles again and compares whole files.
import { readdirSync, readFileSync, writeFileSync } from "node:fs";
import { build } from "esbuild";

const here = new URL(".", import.meta.url);
const read = (path) => readFileSync(new URL(path, here));
const sources = readdirSync(new URL("src", here)).filter((n) => n.endsWith(".ts")).sort().map((n) => `src/${n}`);
sources.push("build.mjs", "package-lock.json", "package.json", "tsconfig.json");

// FNV-1a over the bytes of all sources, as in the crate's test.
let hash = 0xcbf29ce484222325n;
for (const path of sources)
  for (const byte of read(path)) hash = ((hash ^ BigInt(byte)) * 0x100000001b3n) & 0xffffffffffffffffn;
const mark = `// sources ${hash.toString(16).padStart(16, "0")}\n`;

const bundle = (source) => build({
  entryPoints: [source],
  absWorkingDir: new URL(".", here).pathname,
  bundle: true,
  minify: true,
  format: "iife",
  target: "es2022",
  charset: "utf8",
  legalComments: "none",
  metafile: true,
  write: false,
});
// `solid.js` draws bodies and is twice as large as `page.js`. It is therefore evaluated on first use, and a
// page without bodies leaves it out.
const parts = { "page.js": await bundle("src/main.ts"), "solid.js": await bundle("src/solid.ts") };
const built = Object.fromEntries(Object.entries(parts).map(([name, made]) => [name, mark + made.outputFiles[0].text]));

// Licences of the bundled packages.
const packages = new Set();
for (const path of Object.values(parts).flatMap((made) => Object.keys(made.metafile.inputs))) {
  const found = path.match(/^node_modules\/((?:@[^/]+\/)?[^/]+)\//);
  if (found) packages.add(found[1]);
}
const licences = [...packages].sort().map((name) => {
  const folder = `node_modules/${name}`;
  const about = JSON.parse(read(`${folder}/package.json`));
  const file = readdirSync(new URL(folder, here)).find((n) => /^licen[cs]e/i.test(n));
  const text = file ? read(`${folder}/${file}`).toString().trim() : `${about.license}, by its package.json`;
  return `${name} ${about.version}\n\n${text}\n`;
});
built["LICENSES.txt"] = `Packages bundled into page.js and solid.js, with their licences.\n\n${licences.join("\n----\n\n")}`;

if (process.argv.includes("--check")) {
  const other = Object.keys(built).filter((name) => read(`built/${name}`).toString() !== built[name]);
  if (other.length) {
    console.error(`${other.join(", ")} in built/ does not match the sources: run \`npm run build\` in reports/page`);
    process.exit(1);
  }
} else {
  for (const [name, text] of Object.entries(built)) writeFileSync(new URL(`built/${name}`, here), text);
}
const sizes = Object.entries(built).map(([name, text]) => `${name} ${Math.round(text.length / 1024)} kB`);
console.log(`${sizes.join(", ")}, ${packages.size} packages, ${mark.trim()}`);
