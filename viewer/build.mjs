// Makes the page of the viewer, one file without addresses of others: node build.mjs
import { build } from "esbuild";
import { readFile, writeFile } from "node:fs/promises";

const here = (path) => new URL(path, import.meta.url);
const bundle = await build({
  entryPoints: [here("src/main.js").pathname], bundle: true, minify: true, write: false, format: "iife",
  target: ["es2022"], legalComments: "none",
});
const [style, page] = await Promise.all([readFile(here("src/page.css"), "utf8"), readFile(here("src/page.html"), "utf8")]);
const licence = await readFile(here("node_modules/three/LICENSE"), "utf8");
// A script in a page ends at the first "</script".
const script = `/* three.js:\n${licence.trim()}\n*/\n${bundle.outputFiles[0].text}`.replaceAll("</script", "<\\/script");
const made = page.replace("/*STYLE*/", () => style).replace("/*SCRIPT*/", () => script);
const target = here("../python/carom/viewer.html");
await writeFile(target, made);
console.log(`viewer: ${target.pathname}, ${Math.round(made.length / 1024)} KiB`);
