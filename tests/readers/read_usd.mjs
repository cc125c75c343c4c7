// What TinyUSDZ and the parser of three.js read in a .usda file.
import { readFileSync } from "node:fs";
import { basename } from "node:path";
import { USDAParser } from "three/examples/jsm/loaders/usd/USDAParser.js";

// TinyUSDZ is built for browsers, and starts where it takes node for one. Warnings of an
// unfinished feature are no errors.
process.type = "renderer";
globalThis.window = globalThis;
const { default: start } = await import("tinyusdz/tinyusdz.js");
const wasmBinary = readFileSync(new URL(import.meta.resolve("tinyusdz/tinyusdz.wasm")));
const tiny = await start({ wasmBinary, print: () => {}, printErr: () => {} });
delete process.type;
delete globalThis.window;

/// The file as TinyUSDZ writes it again, after reading it as a stage of typed prims.
function again(file) {
  const bytes = new Uint8Array(readFileSync(file));
  for (const read of ["loadFromBinary", "loadAsLayerFromBinary"]) {
    const loader = new tiny.TinyUSDZLoaderNative();
    try {
      if (!loader[read](bytes, basename(file)) || loader.error()) {
        throw new Error(`${basename(file)}: TinyUSDZ cannot read it: ${loader.error().trim()}`);
      }
      if (read === "loadAsLayerFromBinary") return loader.layerToString();
    } finally {
      loader.delete();
    }
  }
}

function curves(text, file, reader) {
  const specs = new USDAParser().parseData(text).specsByPath;
  const root = specs["/"].fields;
  const value = (name) => specs[`/${root.defaultPrim}.${name}`]?.fields;
  const points = value("points")?.timeSamples;
  const extents = value("extent")?.timeSamples;
  if (!points || !extents) throw new Error(`${basename(file)}: ${reader} finds no points`);
  // The parser of three.js leaves these out.
  const of = (name, where) => {
    const found = where.exec(text)?.[1];
    if (found === undefined) throw new Error(`${basename(file)}: ${reader} finds no ${name}`);
    return found;
  };
  const times = points.times.map((code) => code / root.timeCodesPerSecond);
  if (String(points.times) !== String(extents.times)) {
    throw new Error(`${basename(file)}: ${reader} finds other times for extent than points`);
  }
  return {
    file: basename(file),
    reader,
    times,
    counts: value("curveVertexCounts").default,
    widths: value("widths").default,
    ids: value("primvars:strand")?.default,
    frames: points.values.map((x, f) => ({ points: x, extent: extents.values[f] })),
    upright: root.upAxis === "Z" && root.metersPerUnit === 1,
    interpolation: of("interpolation", /float\[\] widths = [^(]*\(\s*interpolation = "(\w+)"/),
    ends: Number(of("endTimeCode", /endTimeCode = (\S+)/)) / root.timeCodesPerSecond,
  };
}

/// One reading by each; throws Error where one cannot read the file.
export function read_usd(file) {
  const parts = again(file);
  return [curves(parts, file, "TinyUSDZ"), curves(readFileSync(file, "utf8"), file, "three.js")];
}
