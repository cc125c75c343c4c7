// One number of one file changed at a time, each of which the test must find.
const replaced = (bytes, pattern, by) => {
  const text = bytes.toString("latin1");
  if (!pattern.test(text)) throw new Error(`nothing to spoil: ${pattern}`);
  return Buffer.from(text.replace(pattern, by), "latin1");
};
const appended = (bytes, array) => {
  const text = bytes.toString("latin1");
  const offset = Number(new RegExp(`${array}[^>]* offset="(\\d+)"`).exec(text)[1]);
  return text.indexOf('<AppendedData encoding="raw">\n_') + 31 + offset + 4;
};
/// A .glb file with its description changed, and its arrays where `change` returns some.
function described(bytes, change) {
  const size = bytes.readUInt32LE(12);
  const file = JSON.parse(bytes.toString("utf8", 20, 20 + size));
  const arrays = bytes.subarray(28 + size);
  change(file, (accessor) => {
    const view = file.bufferViews[file.accessors[accessor].bufferView];
    return arrays.subarray(view.byteOffset, view.byteOffset + view.byteLength);
  });
  const text = JSON.stringify(file);
  const padded = Buffer.from(text.padEnd(text.length + ((4 - (text.length % 4)) % 4)));
  const head = Buffer.from(bytes.subarray(0, 20));
  head.writeUInt32LE(28 + padded.length + arrays.length, 8);
  head.writeUInt32LE(padded.length, 12);
  return Buffer.concat([head, padded, bytes.subarray(20 + size, 28 + size), arrays]);
}
const lines_of = (file) => file.meshes[0].primitives[0];
const add_to = (array, at, more) => array.writeFloatLE(array.readFloatLE(at) + more, at);
const scale = (array, at, by) => array.writeFloatLE(array.readFloatLE(at) * by, at);
/// The bounds that an accessor of `width` numbers each states, made those that it has.
function bound(accessor, array, width) {
  const values = Array.from({ length: array.length / 4 }, (_, i) => array.readFloatLE(4 * i));
  const of = (pick) =>
    Array.from({ length: width }, (_, c) =>
      values.filter((_, i) => i % width === c).reduce((a, b) => pick(a, b)),
    );
  accessor.min = of((a, b) => Math.min(a, b));
  accessor.max = of((a, b) => Math.max(a, b));
}

const more = (number, part) => String(Number(number) * (1 + part));

/// Each: the file to change in a run named `name`, how, and what must be said of it.
/// `away`: twice the tolerance of a coordinate, in m.
export const spoils = (name, away) => [
  {
    what: "a coordinate",
    kind: "vtk",
    file: `${name}_00001.vtp`,
    said: /_00001\.vtp: point 0 of strand \d+ is .* off the run's own/,
    change(bytes) {
      const at = appended(bytes, "<Points>\\n<DataArray");
      bytes.writeFloatLE(bytes.readFloatLE(at) + away, at);
      return bytes;
    },
  },
  {
    what: "a strand",
    kind: "vtk",
    file: `${name}_00001.vtp`,
    said: /_00001\.vtp: strand: 1 instead of 0/,
    change(bytes) {
      bytes.writeInt32LE(1, appended(bytes, 'Name="strand"'));
      return bytes;
    },
  },
  {
    what: "a radius",
    kind: "vtk",
    file: `${name}_00001.vtp`,
    said: /_00001\.vtp: radius: /,
    change(bytes) {
      const at = appended(bytes, 'Name="radius .m."');
      bytes.writeFloatLE(bytes.readFloatLE(at) * (1 + 1e-5), at);
      return bytes;
    },
  },
  {
    what: "the end of a line",
    kind: "vtk",
    file: `${name}_00001.vtp`,
    said: /_00001\.vtp: points of lines: /,
    change(bytes) {
      const at = appended(bytes, 'Name="offsets"');
      bytes.writeInt32LE(bytes.readInt32LE(at) - 1, at);
      return bytes;
    },
  },
  {
    what: "the time of a frame",
    kind: "vtk",
    file: `${name}_00001.vtp`,
    said: /_00001\.vtp: time: /,
    change: (bytes) =>
      replaced(bytes, /format="ascii">([^<]+)/, (_, t) => `format="ascii">${more(t, 1e-6)}`),
  },
  {
    what: "half of the file",
    kind: "vtk",
    file: `${name}_00001.vtp`,
    said: /_00001\.vtp: VTK cannot read it/,
    change: (bytes) => bytes.subarray(0, bytes.length / 2),
  },
  {
    what: "a time of the list",
    kind: "vtk",
    file: `${name}.pvd`,
    said: /\.pvd: times: /,
    change: (bytes) =>
      replaced(bytes, /timestep="(0\.\d+)"/, (_, t) => `timestep="${more(t, 1e-6)}"`),
  },
  {
    what: "a coordinate",
    kind: "usd",
    file: `${name}.usda`,
    said: /\.usda by TinyUSDZ, frame 0: point 0 of strand \d+ is .* off the run's own/,
    change: (bytes) =>
      replaced(bytes, /(points\.timeSamples = \{\s+0: \[\()([^,]+)/, (_, before, x) => {
        return before + (Number(x) + away);
      }),
  },
  {
    // TinyUSDZ writes six digits of a time.
    what: "a time",
    kind: "usd",
    file: `${name}.usda`,
    said: /\.usda: three\.js finds other times for extent than points/,
    change: (bytes) =>
      replaced(bytes, /(points\.timeSamples = \{\s+.*\n\s+)([^:]+)/, (_, before, t) => {
        return before + more(t, 1e-6);
      }),
  },
  {
    what: "frames a second",
    kind: "usd",
    file: `${name}.usda`,
    said: /\.usda by TinyUSDZ: times: /,
    change: (bytes) => replaced(bytes, /timeCodesPerSecond = 30/, "timeCodesPerSecond = 31"),
  },
  {
    what: "a width",
    kind: "usd",
    file: `${name}.usda`,
    said: /\.usda by TinyUSDZ: widths: /,
    change: (bytes) => replaced(bytes, /(widths = \[)([^,]+)/, (_, b, w) => b + more(w, 1e-5)),
  },
  {
    what: "a strand",
    kind: "usd",
    file: `${name}.usda`,
    said: /\.usda by TinyUSDZ: strand: 1 instead of 0/,
    change: (bytes) => replaced(bytes, /(primvars:strand = \[)0,/, "$11,"),
  },
  {
    what: "an extent",
    kind: "usd",
    file: `${name}.usda`,
    said: /\.usda by TinyUSDZ, frame 0: extent: /,
    change: (bytes) =>
      replaced(bytes, /(extent\.timeSamples = \{\s+0: \[\()([^,]+)/, (_, before, x) => {
        return before + (Number(x) + away);
      }),
  },
  {
    what: "half of the file",
    kind: "usd",
    file: `${name}.usda`,
    said: /\.usda: TinyUSDZ cannot read it/,
    change: (bytes) => bytes.subarray(0, bytes.length / 2),
  },
  {
    what: "a coordinate",
    kind: "hair",
    file: `${name}_00001.hair`,
    said: /_00001\.hair: point 0 of strand \d+ is .* off the run's own/,
    change(bytes) {
      const at = 128 + 2 * bytes.readUInt32LE(4);
      bytes.writeFloatLE(bytes.readFloatLE(at) + away, at);
      return bytes;
    },
  },
  {
    what: "the thickness",
    kind: "hair",
    file: `${name}_00001.hair`,
    said: /_00001\.hair: thickness: /,
    change(bytes) {
      bytes.writeFloatLE(bytes.readFloatLE(20) * (1 + 1e-5), 20);
      return bytes;
    },
  },
  ...[
    {
      what: "a coordinate",
      said: /\.glb by three\.js, frame 1: point 0 of strand \d+ is .* off the run's own/,
      change: (file, array) => {
        const { POSITION } = lines_of(file).targets[0];
        const values = array(POSITION);
        add_to(values, 0, away);
        bound(file.accessors[POSITION], values, 3);
      },
    },
    {
      what: "a strand",
      said: /\.glb by three\.js: strand: 1 instead of 0/,
      change: (file, array) => add_to(array(lines_of(file).attributes._STRAND), 0, 1),
    },
    {
      what: "a radius",
      said: /\.glb by three\.js: radius: /,
      change: (file, array) => scale(array(lines_of(file).attributes._RADIUS), 0, 1 + 1e-5),
    },
    {
      what: "a channel of a later frame",
      said: /\.glb by glTF-Transform, frame 1: curvature: /,
      change: (file, array) => add_to(array(lines_of(file).targets[0]._CURVATURE), 0, 1e3),
    },
    {
      what: "the end of a line",
      said: /\.glb by three\.js: points of lines: /,
      change: (file) => (file.accessors[lines_of(file).indices].count -= 2),
    },
    {
      what: "a time",
      said: /\.glb by three\.js: times: /,
      change: (file, array) => {
        const { input } = file.animations[0].samplers[0];
        const values = array(input);
        scale(values, 4, 1 + 1e-6);
        bound(file.accessors[input], values, 1);
      },
    },
    {
      what: "a weight",
      said: /\.glb by three\.js, frame 1: point \d+ is .* off the page's/,
      change: (file, array) => {
        const values = array(file.animations[0].samplers[0].output);
        values[lines_of(file).targets.length] = 0;
      },
    },
    {
      what: "the axis that is up",
      said: /\.glb by three\.js, frame 0: point 0 /,
      change: (file) => delete file.nodes[0].rotation,
    },
    {
      what: "a bound",
      said: /\.glb: ACCESSOR_MAX_MISMATCH/,
      change: (file) => (file.accessors[lines_of(file).attributes.POSITION].max[0] += 1e-3),
    },
  ].map(({ change, ...rest }) => ({
    ...rest,
    kind: "gltf",
    file: `${name}.glb`,
    change: (bytes) => described(bytes, change),
  })),
  {
    what: "half of the file",
    kind: "gltf",
    file: `${name}.glb`,
    said: /\.glb: GLB_/,
    change: (bytes) => bytes.subarray(0, bytes.length / 2),
  },
];
