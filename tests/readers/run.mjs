// Files that other programs open, read by readers that are not ours.
//
//   node run.mjs SIMULATE     the program that runs scenes
//
// Scenes of the repository, shortened: a curl, a head, strands of two radii, a tree. Their
// .vtp and .pvd files are read by VTK, their .usda by TinyUSDZ and by the parser of three.js,
// their .glb by Khronos' validator, three.js and glTF-Transform, and by Blender where that is
// installed, which draws one; the .h5 of the head by h5py; .hair files, of which no reader is
// to be had, after their description. All must have the points of the run within 1e-6 of the
// longest line, its times, widths and strands.
// Then one number of one file is spoilt at a time: is it found? Exit codes: 0 all is well,
// 2 usage, 3 something differs.
import { execFileSync, spawnSync } from "node:child_process";
import * as fs from "node:fs";
import { tmpdir } from "node:os";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { check, check_drawn, longest } from "./check.mjs";
import { read_hair, read_own } from "./own.mjs";
import { read_gltf } from "./read_gltf.mjs";
import { read_usd } from "./read_usd.mjs";
import { spoils } from "./spoils.mjs";

const here = dirname(fileURLToPath(import.meta.url));
// A last frame between two frames' times, and a head of which every second strand is shown.
const scenes = [
  { name: "curly_clump_oscillation", changes: [[/^duration_s = .*$/m, "duration_s = 0.0251"]] },
  {
    name: "full_head",
    changes: [
      [/^duration_s = .*$/m, "duration_s = 0.035"],
      [/^count = .*$/m, "count = 2000"],
    ],
  },
  {
    name: "stiff_and_soft",
    changes: [
      [/^duration_s = .*$/m, "duration_s = 0.02"],
      [/^youngs_modulus_pa = .*$/m, "radius_m = 30e-6"],
    ],
    thin: (strand) => strand >= 50,
    blender: true,
  },
  { name: "willow", changes: [[/^duration_s = .*$/m, "duration_s = 0.05"]] },
];

function run(simulate, { name, changes }, work) {
  let scene = fs.readFileSync(join(here, "../../scenes", `${name}.toml`), "utf8");
  for (const [line, by] of changes) {
    if (!line.test(scene)) throw new Error(`${name}.toml: no line ${line}`);
    scene = scene.replace(line, by);
  }
  const file = join(work, `${name}.toml`);
  fs.writeFileSync(file, scene);
  const flags = ["--out", work, "--export", "vtk,usd,hair,gltf", "--progress", "none"];
  execFileSync(simulate, [file, ...flags], { stdio: ["ignore", "ignore", "pipe"] });
}

function read_vtk(files) {
  const options = { maxBuffer: 1 << 30, encoding: "utf8" };
  const made = spawnSync("/usr/bin/python3", [join(here, "read_vtk.py"), ...files], options);
  if (made.status !== 0) throw new Error(`read_vtk.py: ${made.error ?? made.stderr}`);
  return made.stdout
    .trim()
    .split("\n")
    .map((line) => JSON.parse(line));
}

const told = (error) => ({ error: error.message });
/// Where Blender is installed: what it finds in a .glb, and whether its picture shows it.
function read_blender(name, work, radius) {
  const script = join(here, "read_blender.py");
  const files = [join(work, `${name}.glb`), String(radius), join(work, `${name}.png`)];
  const flags = ["--background", "--factory-startup", "--python-exit-code", "1"];
  const options = { encoding: "utf8", maxBuffer: 1 << 30 };
  const made = spawnSync("blender", [...flags, "--python", script, "--", ...files], options);
  if (made.error?.code === "ENOENT") return undefined;
  const said = (what) => new RegExp(`^${what} (.*)$`, "m").exec(made.stdout)?.[1];
  if (made.status !== 0 || said("covered") === undefined) {
    throw new Error(`read_blender.py: ${made.error ?? made.stderr}`);
  }
  const covered = Number(said("covered"));
  return { file: `${name}.glb`, covered, ...JSON.parse(said("found")) };
}

const attempt = (read) => {
  try {
    return read();
  } catch (error) {
    return told(error);
  }
};
const seconds = (since) => ((performance.now() - since) / 1000).toFixed(2);
const digits = (x) => x.toExponential(1);

function size(path) {
  if (!fs.statSync(path).isDirectory()) return fs.statSync(path).size;
  return fs.readdirSync(path).reduce((sum, name) => sum + fs.statSync(join(path, name)).size, 0);
}

/// Complaints about the files of one scene, and what was read.
async function read_back(name, work, simulated) {
  const since = performance.now();
  const stem = join(work, name);
  const pvd = `${name}.pvd`;
  const head = name === "full_head";
  const files = [join(`${stem}_vtk`, pvd), ...(head ? [`${stem}.h5`] : [])];
  const [vtk, h5] = read_vtk(files);
  const readings = {
    own: read_own(stem, h5),
    vtk: { pvd, read: vtk },
    usd: attempt(() => read_usd(`${stem}.usda`)),
    hair: attempt(() => read_hair(`${stem}_hair`)),
    gltf: await read_gltf(`${stem}.glb`).catch(told),
  };
  const { complaints, figures } = check(readings);
  const kB = (path) => `${(size(path) / 1000).toFixed(0)} kB`;
  console.log(
    `${name}: ${readings.own.times.length} frames of ${readings.own.counts.length} lines; ` +
      `.vtp ${kB(`${stem}_vtk`)}, .usda ${kB(`${stem}.usda`)}, .hair ${kB(`${stem}_hair`)}, ` +
      `.glb ${kB(`${stem}.glb`)}; ` +
      `off the run's own ${digits(figures.own)}, between readers ${digits(figures.readers)} ` +
      `of the longest line, off the page's ${figures.page.toFixed(3)} of its steps; ` +
      `simulated in ${simulated} s, read in ${seconds(since)} s`,
  );
  return { complaints, readings };
}

/// Complaints about what Blender finds and draws; none where it is not installed.
function drawn_by_blender(name, work, readings) {
  const since = performance.now();
  const width = 2e-3; // of the longest line: a tube is seen
  const radius = width * longest(readings.own.counts, readings.own.frames[0]);
  const found = read_blender(name, work, radius);
  if (found === undefined) {
    console.log("Blender is not installed: its test is left out");
    return [];
  }
  const { complaints, figures } = check_drawn(found, readings.gltf[0], readings.own);
  console.log(
    `Blender: ${found.counts.length} lines, off three.js ${digits(figures.off)} of the longest, ` +
      `${(100 * found.covered).toFixed(2)} % of its picture covered, in ${seconds(since)} s`,
  );
  return complaints;
}

/// Spoils that are not found.
async function spoil(name, readings, work) {
  const scale = longest(readings.own.counts, readings.own.frames[0]);
  const all = spoils(name, 2e-6 * scale);
  const spoilt = all.map(({ kind, file, change }, i) => {
    const folder = join(work, `spoilt_${i}`);
    const alone = kind === "usd" || kind === "gltf"; // one file of all frames
    const from = alone ? work : join(work, `${name}_${kind}`);
    fs.mkdirSync(folder);
    if (alone) fs.cpSync(join(from, file), join(folder, file));
    else fs.cpSync(from, folder, { recursive: true });
    fs.writeFileSync(join(folder, file), change(fs.readFileSync(join(from, file))));
    return folder;
  });
  const pvd = `${name}.pvd`;
  const vtk = all.flatMap(({ kind }, i) => (kind === "vtk" ? [join(spoilt[i], pvd)] : []));
  const read = read_vtk(vtk);
  const missed = [];
  for (const [i, { what, kind, file, said }] of all.entries()) {
    const by_kind = {
      vtk: () => ({ pvd, read: read.shift() }),
      usd: () => attempt(() => read_usd(join(spoilt[i], file))),
      hair: () => attempt(() => read_hair(spoilt[i])),
      gltf: () => read_gltf(join(spoilt[i], file)).catch(told),
    };
    const { complaints } = check({ ...readings, [kind]: await by_kind[kind]() });
    if (complaints.some((complaint) => said.test(complaint))) continue;
    missed.push(
      `${file}: ${what} was spoilt, which is not found (${complaints.join("; ") || "nothing said"})`,
    );
  }
  return missed;
}

const simulate = resolve(process.argv[2] ?? "");
if (process.argv.length !== 3) {
  console.error("usage: run.mjs SIMULATE");
  process.exit(2);
}
const work = fs.mkdtempSync(join(tmpdir(), "tress-readers-"));
const failures = [];
try {
  for (const scene of scenes) {
    const since = performance.now();
    run(simulate, scene, work);
    const { complaints, readings } = await read_back(scene.name, work, seconds(since));
    const { ids, radii } = readings.own;
    if (scene.thin && ids.some((k, line) => scene.thin(k) !== (radii[line] === 30e-6))) {
      complaints.push(`${scene.name}: radii that the scene does not give`);
    }
    if (scene.blender) complaints.push(...drawn_by_blender(scene.name, work, readings));
    failures.push(...complaints);
    if (scene.name !== "full_head" || complaints.length) continue;
    const began = performance.now();
    const missed = await spoil(scene.name, readings, work);
    const count = spoils(scene.name, 0).length;
    console.log(`spoilt files: ${count - missed.length} of ${count} found in ${seconds(began)} s`);
    failures.push(...missed);
  }
} finally {
  fs.rmSync(work, { recursive: true, force: true });
}
for (const failure of failures) console.log(`FAILED: ${failure}`);
process.exitCode = failures.length ? 3 : 0;
