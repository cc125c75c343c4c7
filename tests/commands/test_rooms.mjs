// test_rooms.mjs REPOSITORY: dependencies between folders run one way, and no folder is full.
import { readFileSync, readdirSync } from "node:fs";
import { dirname, join } from "node:path";

const repository = process.argv[2];

// What each room at the top level may include, besides itself.
const may_see = {
  math: [],
  contract: ["math"],
  linear: ["contract", "math"],
  models: ["math", "contract", "linear"],
  integrators: ["contract", "linear"],
  simulation: ["math", "contract", "linear", "models", "integrators"],
  experiments: ["math", "contract", "linear", "models", "integrators", "simulation"],
  python: ["math", "contract", "linear", "models", "integrators", "simulation", "experiments"],
};
// Below experiments/: everything else is a study, which sees no other study.
const shared = ["experiments/run", "experiments/problems", "experiments/numerics"];
const most_files = 40; // in one folder

function sources(folder) {
  return readdirSync(join(repository, folder), { withFileTypes: true }).flatMap((entry) => {
    const path = `${folder}/${entry.name}`;
    if (entry.isDirectory()) return entry.name === "node_modules" ? [] : sources(path);
    return /\.(h|cpp)$/.test(entry.name) ? [path] : [];
  });
}

const complaints = [];
const below = new Map(); // folder -> folder it includes -> a line that does
const count = new Map();
const room_of = (path) => path.split("/")[0];
const study_of = (path) => path.split("/").slice(0, 2).join("/");
let lines = 0;

for (const file of Object.keys(may_see).flatMap(sources)) {
  const folder = dirname(file);
  count.set(folder, (count.get(folder) ?? 0) + 1);
  for (const [, target] of readFileSync(join(repository, file), "utf8").matchAll(
    /^#include "(.+)"$/gm,
  )) {
    ++lines;
    const [room, other] = [room_of(file), room_of(target)];
    if (room !== other && !may_see[room].includes(other)) {
      complaints.push(`${file} includes ${target}: ${room} must not see ${other}`);
    }
    const [study, its] = [study_of(file), study_of(target)];
    if (room === "experiments" && other === room && study !== its && !shared.includes(its)) {
      complaints.push(`${file} includes ${target}: of another study`);
    }
    if (dirname(target) === folder) continue;
    if (!below.has(folder)) below.set(folder, new Map());
    below.get(folder).set(dirname(target), `${file} includes ${target}`);
  }
}

// Depth first; a folder on the path that is met again closes a cycle.
const done = new Set();
function visit(folder, path) {
  if (path.includes(folder)) {
    const cycle = [...path.slice(path.indexOf(folder)), folder];
    const why = cycle.slice(1).map((next, i) => below.get(cycle[i]).get(next));
    complaints.push(`folders in a cycle: ${cycle.join(" -> ")}\n  ${why.join("\n  ")}`);
    return;
  }
  if (done.has(folder)) return;
  for (const next of below.get(folder)?.keys() ?? []) visit(next, [...path, folder]);
  done.add(folder);
}
for (const folder of below.keys()) visit(folder, []);

for (const [folder, files] of count) {
  if (files > most_files) complaints.push(`${folder} has ${files} files, more than ${most_files}`);
}

console.log(`${count.size} folders, ${lines} includes`);
if (lines < 1000) complaints.push("hardly any include was found: is this the repository?");
for (const complaint of complaints) console.error(complaint);
process.exit(complaints.length > 0 ? 1 : 0);
