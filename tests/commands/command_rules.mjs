// What test_pages.mjs does with the pages' commands other than running them as they stand.

/// What a reader has before a page's first command, as bash, by page.
const short_scene = (name, seconds) =>
  `sed -i 's/^duration_s = .*/duration_s = ${seconds}/' scenes/${name}.toml`;
const my_scene =
  'build/release/experiments/simulate --print-defaults | ' +
  "sed 's/^duration_s = .*/duration_s = 0.05/' > my.toml";
const page_alone =
  'node experiments/report/dist/report.mjs results --out results/report.html --no-figures';
export const before = {
  'docs/compare.md': ['mkdir ../other', 'cp -r results ../other/'],
  'docs/grooms.md': [my_scene],
  'docs/how_to_choose.md': [my_scene],
  'docs/player.md': [
    ...['crossing_locks', 'full_head', 'head_shaking', 'plectoneme'].map((name) =>
      short_scene(name, 0.05),
    ),
    "sed -i 's/^count = .*/count = 1000/' scenes/full_head.toml",
    "sed -i 's/^frames_1_s = .*/frames_1_s = 300/' scenes/crossing_locks.toml",
    'build/release/experiments/simulate scenes/{crossing_locks,full_head,head_shaking,plectoneme}.toml',
  ],
  'experiments/calibrate/data/README.md': [
    'cut -d, -f1,2 experiments/calibrate/data/one_length.csv > measured.csv',
  ],
  'experiments/cost_of_accuracy/README.md': [my_scene],
  'experiments/head_accuracy/README.md': [
    short_scene('full_head', 0.05),
    "sed -i 's/^count = .*/count = 1000/' scenes/full_head.toml",
  ],
  'experiments/heads/README.md': [
    "sed 's/^count = .*/count = 1000/; s/^duration_s = .*/duration_s = 0.02/' " +
      'scenes/full_head.toml > my_head.toml',
  ],
  'experiments/matrices/README.md': [my_scene],
  'experiments/report/README.md': [
    short_scene('cantilever', 0.1),
    'build/release/experiments/simulate scenes/cantilever.toml',
    page_alone,
  ],
};

/// Each is for the commands of a page that begin with `command`. One of:
///   more: options that make it quick, put at its end;
///   instead: what stands in its place in what begins with `command`, and why;
///   exits: exit codes beside 0 that are an answer too, and why;
///   left_out: why it is not run here; by: the test that runs it, where one does.
const of_cluster = {
  left_out: 'needs a cluster: ./tress test --cluster',
  by: 'tests/cluster/test_cluster.sh',
};
const of_plugin = { left_out: 'its own test', by: 'tests/plugin/test_plugin.sh' };
const experiment = (name) => `build/release/experiments/${name}`;
export const rules = [
  { page: 'README.md', command: './tress run', left_out: 'takes a third of an hour' },
  { page: 'README.md', command: './tress test', left_out: 'runs this' },
  { page: 'README.md', command: './tress build', left_out: 'compiles all programs' },
  {
    page: 'docs/start/own_scene.md',
    command: `${experiment('simulate')} --print-defaults > my.toml`,
    instead: my_scene,
    why: 'a shorter scene',
  },
  {
    page: 'docs/start/own_scene.md',
    command: `${experiment('cost_of_accuracy')} --advise`,
    more: '--models super_helix --integrators tr_bdf2',
  },
  {
    page: 'docs/start/own_scene.md',
    command: `${experiment('hard_cases')} --scene`,
    more: '--models super_helix,der --quick',
  },
  { page: 'docs/cluster.md', command: './tress cluster', ...of_cluster },
  { page: 'docs/cluster.md', command: 'mpirun', ...of_cluster },
  {
    page: 'docs/compare.md',
    command: './tress compare HEAD~1',
    left_out: 'builds two commits',
  },
  {
    page: 'docs/compare.md',
    command: './tress compare build/bench',
    left_out: 'needs two builds of the benchmarks',
  },
  {
    page: 'docs/extending.md',
    command: `${experiment('constraint_drift')} --integrators`,
    more: '--models inextensible_chain --quick',
  },
  {
    page: 'docs/extending.md',
    command: `${experiment('stability_limit')} --elements`,
    more: '--models super_helix --set damping=seed',
  },
  {
    page: 'docs/how_to_choose.md',
    command: `${experiment('cost_of_accuracy')} --advise`,
    more: '--quick --models super_helix --integrators tr_bdf2',
  },
  {
    page: 'docs/player.md',
    command: './tress report',
    instead: page_alone,
    why: 'README.md has it too, and the figures take seconds',
  },
  {
    page: 'docs/player.md',
    command:
      "./tress film results/report.html 'scene=head_shaking&colour=hair' head_shaking.webm",
    more: '--size 160,120 --rate 5',
  },
  {
    page: 'docs/player.md',
    command:
      "./tress film results/scenes/plectoneme.json 'view=-60,15,2' plectoneme_pictures --rate 10 --size 1920,1080",
    more: '--size 160,120',
  },
  {
    page: 'docs/player.md',
    command:
      "./tress film results/report.html 'scene=full_head&colour=hair' print --size 3840,2160 --scale 2 --from 1 --to 1",
    more: '--size 160,120 --from 0 --to 0',
  },
  { page: 'docs/plugins.md', command: '', ...of_plugin },
  {
    page: 'docs/python.md',
    command: './tress python',
    left_out: 'builds, and runs its own tests',
  },
  {
    page: 'docs/python.md',
    command: '/usr/bin/python3 -m venv',
    left_out: 'for the next line',
  },
  { page: 'docs/python.md', command: 'my_environment', left_out: 'compiles for minutes' },
  {
    page: 'experiments/calibrate/data/README.md',
    command: `${experiment('calibrate')} --set data=measured.csv`,
    exits: [3],
    why: 'a record of another hair, which it says',
  },
  {
    page: 'experiments/cost_of_accuracy/README.md',
    command: `${experiment('cost_of_accuracy')} --advise`,
    more: '--quick --integrators tr_bdf2',
  },
  {
    page: 'experiments/head_accuracy/README.md',
    command: `${experiment('head_accuracy')} --scene`,
    more: '--quick',
  },
  {
    page: 'experiments/heads/README.md',
    command: `${experiment('simulate')} my_head.toml --as head --device gpu`,
    exits: [2],
    why: 'where there is no GPU',
  },
  {
    page: 'experiments/heads/README.md',
    command: `${experiment('heads')} --strands 50000,1000000 --elements 5,20`,
    instead: `${experiment('heads')} --strands 32,64 --elements 5`,
    more: '--quick',
    exits: [3],
    why: 'minutes and gigabytes; claims are of more hairs than that',
  },
  {
    page: 'experiments/matrices/README.md',
    command: './tress matrices',
    instead: `${experiment('matrices')} --scene`,
    why: 'builds first, for which a copy of the sources has no tree',
  },
];
