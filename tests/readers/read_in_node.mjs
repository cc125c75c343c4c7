// node read_in_node.mjs FILE...: what readers that are npm packages find in .usda and .glb
// files: for each FILE a line of JSON, a list of readings or {"error": why}. Here is only what
// needs these packages; run.py compares the readings.
import { read_gltf } from "./read_gltf.mjs";
import { read_usd } from "./read_usd.mjs";

for (const file of process.argv.slice(2)) {
  const read = file.endsWith(".glb") ? read_gltf : read_usd;
  let found;
  try {
    found = await read(file);
  } catch (error) {
    found = { error: error.message };
  }
  console.log(JSON.stringify(found));
}
