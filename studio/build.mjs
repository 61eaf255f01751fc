// Bundles the studio's page into one HTML file: ../build/studio/index.html, or the folder named after --out.
// Two builds of the same sources give the same bytes: nothing of the time, the machine or the folder goes in.
import { build } from "esbuild";
import { existsSync, mkdirSync, readFileSync, readdirSync, writeFileSync } from "node:fs";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const named = process.argv.indexOf("--out");
const out = named > 0 ? resolve(process.argv[named + 1]) : resolve(here, "../build/studio");

// `--tests` bundles the tests of its parts instead, for Node's own test runner.
if (process.argv.includes("--tests")) {
  const folder = resolve(here, "../tests/studio_page/unit");
  await build({
    absWorkingDir: here,
    entryPoints: readdirSync(folder).filter((f) => f.endsWith(".test.ts")).map((f) => join(folder, f)),
    bundle: true,
    format: "esm",
    platform: "node",
    outdir: join(out, "tests"),
    outExtension: { ".js": ".mjs" },
    nodePaths: [join(here, "node_modules")],
    logLevel: "error",
  });
  process.exit(0);
}

const result = await build({
  absWorkingDir: here,
  entryPoints: ["src/main.tsx"],
  bundle: true,
  minify: true,
  write: false,
  metafile: true,
  format: "iife",
  target: ["es2022"],
  charset: "utf8",
  legalComments: "none", // the licences stand together, whole, below
  jsx: "automatic",
  jsxImportSource: "preact",
  loader: { ".css": "text" },
  outfile: "studio.js",
});

// The licence of every package of which anything was taken.
function licences(inputs) {
  const packages = new Set();
  for (const file of Object.keys(inputs)) {
    const at = file.lastIndexOf("node_modules/");
    if (at < 0) continue;
    const parts = file.slice(at + "node_modules/".length).split("/");
    packages.add(parts[0].startsWith("@") ? `${parts[0]}/${parts[1]}` : parts[0]);
  }
  return [...packages].sort().map((name) => {
    const folder = join(here, "node_modules", name);
    const { version, license } = JSON.parse(readFileSync(join(folder, "package.json"), "utf8"));
    const file = ["LICENSE", "LICENSE.md", "LICENSE.txt", "license", "LICENCE"].find((f) => existsSync(join(folder, f)));
    if (!file) throw new Error(`${name} has no licence file`);
    return `${name} ${version} (${license})\n\n${readFileSync(join(folder, file), "utf8").trim()}\n`;
  });
}

// Inside an element of HTML nothing may look like its end.
const inline = (text) => text.replace(/<\/(script|style)/gi, "<\\/$1").replace(/<!--/g, "<\\!--");
const escape = (text) => text.replace(/&/g, "&amp;").replace(/</g, "&lt;");

const script = result.outputFiles[0].text;
const packages = licences(result.metafile.inputs);
const html = `<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>Étendue studio</title>
<link rel="icon" href="data:image/svg+xml,${encodeURIComponent(readFileSync(join(here, "src/icon.svg"), "utf8").trim())}">
<style>${readFileSync(join(here, "src/first.css"), "utf8").trim()}</style>
</head>
<body>
<div id="app"></div>
<noscript>The studio needs JavaScript.</noscript>
<template id="licences">${escape(packages.join(`\n${"-".repeat(80)}\n\n`))}</template>
<script>${inline(script)}</script>
</body>
</html>
`;
mkdirSync(out, { recursive: true });
writeFileSync(join(out, "index.html"), html);
console.log(`${join(out, "index.html")}: ${Math.round(html.length / 1024)} kB, ${packages.length} packages`);
