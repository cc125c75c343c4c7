// Scene files without a browser: what the command refuses, and the geometry of the
// picture.
import assert from 'node:assert/strict';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { inflateRawSync } from 'node:zlib';
import { bodies_at } from '../../experiments/report/src/browser/scenes/bodies.mjs';
import { Camera, project } from '../../experiments/report/src/browser/scenes/camera.mjs';
import {
  arrays_of,
  decode_scene,
  pose_at,
  positions_at,
} from '../../experiments/report/src/browser/scenes/data.mjs';
import { packed } from '../../experiments/report/src/packed.mjs';
import { bytes_of_letters } from '../../experiments/report/src/letters.mjs';
import {
  bytes_of_contacts,
  contacts_of_bytes,
} from '../../experiments/report/src/contact_packing.mjs';
import {
  bytes_of_scene,
  most_levels,
  page_levels,
  scene_of_bytes,
} from '../../experiments/report/src/packing.mjs';
import { empty_directory, fixture_directory, remove, run_page } from './support.mjs';

let directory;
before(() => {
  directory = fixture_directory();
});
after(() => remove(directory));

const fixture = (name) =>
  JSON.parse(readFileSync(join(directory, 'scenes', `${name}.json`), 'utf8'));

// What the command says of one scene file with this text.
function run_with(text, other_text) {
  const other = empty_directory();
  mkdirSync(join(other, 'scenes'));
  writeFileSync(join(other, 'scenes', 'a.json'), text);
  if (other_text !== undefined) writeFileSync(join(other, 'scenes', 'b.json'), other_text);
  const { status, stderr } = run_page(other);
  const page =
    status === 0 ? readFileSync(join(other, 'report.html'), 'utf8') : undefined;
  remove(other);
  return { status, stderr, page };
}

function refusal(...texts) {
  const { status, stderr } = run_with(...texts);
  assert.equal(status, texts.length === 1 ? 2 : 0, stderr);
  const [warning] = stderr.trim().split('\n');
  assert.match(warning, /^report: warning: .*; .*(again|remove)/);
  return warning;
}

test('MalformedScenes_AreOneLineWithFileAndKey', () => {
  assert.match(refusal('{'), /scenes\/a\.json: not valid JSON/);
  assert.match(refusal('[]'), /a\.json: must be a JSON object/);
  const scene = fixture('fixture_wind');
  const changed = (change) => {
    const copy = structuredClone(scene);
    change(copy);
    return refusal(JSON.stringify(copy));
  };
  for (const key of Object.keys(scene)) {
    if (key === 'guides') continue;
    const said = changed((s) => delete s[key]);
    assert.match(said, new RegExp(`scenes/a\\.json: key '${key}`), key);
  }
  const cases = [
    [(s) => (s.format = 'tress-strands-2'), /'format': must be 'tress-strands-1'/],
    [(s) => (s.title = 1), /'title': must be a text/],
    [(s) => (s.model = ''), /'model': must be a text that is not empty/],
    [(s) => (s.dt_s = 0), /'dt_s': must be a positive number/],
    [(s) => (s.times_s[3] = s.times_s[2]), /'times_s': must hold growing numbers/],
    [(s) => (s.times_s = []), /'times_s'/],
    [(s) => (s.strand_points = [1]), /'strand_points': .* at least 2/],
    [(s) => (s.guides = 2), /'guides': must be a whole number up to 1/],
    [(s) => (s.low[1] = s.high[1] + 1), /'high': must not be less/],
    [(s) => (s.high[1] = 1e300), /'high': .* nor 1000000000 m more/],
    [(s) => (s.low = [0, 0, null]), /'low': must hold three numbers/],
    [(s) => s.times_s.pop(), /'positions': 3780 bytes where 29 frames of 21 points need 3654/],
    [(s) => (s.positions = '*'.repeat(8)), /'positions': is not base64/],
    [(s) => (s.channels = [{ name: 'c', unit: 'm' }]), /'channels\[0\]\.low'/],
    [
      (s) => (s.channels = [{ name: 'c', unit: '', low: 0, high: 1, values: 'AAAA' }]),
      /'channels\[0\]\.values': 3 bytes where 30 frames of 21 points need 630/,
    ],
    [(s) => (s.bodies[1].shape = 'cube'), /'bodies\[1\]\.shape': must be one of plane/],
    [(s) => (s.bodies[1].half_axes_m[0] = -1), /'bodies\[1\]\.half_axes_m'/],
    [(s) => s.bodies[0].poses.push(s.bodies[0].poses[0]), /'bodies\[0\]\.poses': .*30/],
    [(s) => (s.bodies[0].poses[0][3] = 2), /'bodies\[0\]\.poses\[0\]': .*length 1/],
    [(s) => (s.bodies = [null]), /'bodies\[0\]/],
    [(s) => (s.contacts = []), /'contacts': must hold 30 arrays/],
    [(s) => (s.contacts = Array(30).fill([1, 2, 3])), /'contacts\[0\]': must hold six/],
    [(s) => (s.contacts = Array(30).fill([0, 0, 0, 0, 0, null])), /'contacts\[0\]'/],
    [(s) => (s.channels = [null]), /'channels\[0\]/],
    [(s) => (s.series.columns[0] = 'x'), /'series\.columns'/],
    [(s) => (s.series.columns[1] = 't_s'), /'series\.columns': a name appears twice/],
    [(s) => s.series.rows[4].pop(), /'series\.rows\[4\]'/],
    [(s) => (s.series.rows[4][0] = null), /'series\.rows\[4\]'/],
  ];
  for (const [change, wanted] of cases) assert.match(changed(change), wanted);
  const text = JSON.stringify(scene);
  assert.match(refusal(text, text), /b\.json: another file holds the scene 'fixture_wind'/);
});

test('Scene_CannotEndTheScriptThatCarriesIt', () => {
  const scene = fixture('fixture_wind');
  scene.title = '</script><script>alert(1)</script>';
  const { status, page } = run_with(JSON.stringify(scene));
  assert.equal(status, 0);
  assert.ok(!page.includes('<script>alert'));
});

test('WithoutScenes_TheTabSaysHowToMakeThem', () => {
  const other = empty_directory();
  assert.equal(run_page(other).status, 0);
  const page = readFileSync(join(other, 'report.html'), 'utf8');
  assert.match(page, /No scene is there yet/);
  remove(other);
});

// Words are 16 bits of the box: half a word is the most that rounding may take, the rest is
// double rounding. Between frames the blend of the two.
test('Positions_AreThoseWrittenToHalfAWord', () => {
  const scene = decode_scene(arrays_of(fixture('fixture_wind')));
  const word = Math.max(...scene.high.map((h, i) => (h - scene.low[i]) / 65535));
  const out = new Float64Array(3 * scene.points);
  const made = (f, s) => [
    0.1 * s + 0.03 * s * s * Math.sin((8 * f) / 40),
    0.01 * Math.sin(6 * s),
    0.12 - 0.1 * s * s,
  ];
  for (const moment of [0, 7, 29, 7.25]) {
    positions_at(scene, moment, out);
    const [f, part] = [Math.floor(moment), moment % 1];
    for (let p = 0; p < 21; ++p) {
      const [now, next] = [made(f, p / 20), made(f + 1, p / 20)];
      now.forEach((x, i) => {
        const wanted = (1 - part) * x + part * next[i];
        assert.ok(Math.abs(out[3 * p + i] - wanted) <= 0.501 * word, `${moment} ${p}`);
      });
    }
  }
});

// Half a step of the grid, and half a word of the box for each of the two roundings; channels
// half a level of 63. Also where differences wrap: noise over all words.
test('Packing_KeepsWhatAPictureShows', () => {
  const head = arrays_of(fixture('fixture_head'));
  let seed = 1;
  const noise = () => (seed = (16807 * seed) % 2147483647) >>> 8;
  const noisy = {
    ...head,
    positions: head.positions.map(noise),
    channels: head.channels.map((channel) => ({
      ...channel,
      values: channel.values.map(noise),
    })),
  };
  const sides = head.high.map((x, i) => x - head.low[i]);
  const longest = Math.max(...sides);
  for (const scene of [head, noisy, { ...head, channels: [] }])
    for (const levels of [page_levels, most_levels]) {
      const { positions, channels, contacts, series, usual_force_n, ...rest } =
        scene_of_bytes(bytes_of_scene(scene, levels));
      for (const key of Object.keys(rest)) assert.deepEqual(rest[key], scene[key], key);
      positions.forEach((word, i) => {
        const side = sides[i % 3];
        const off = (Math.abs(word - scene.positions[i]) / 65535) * side;
        const allowed = (0.5 / levels) * longest + (0.5 / 65535) * side;
        assert.ok(off <= allowed * (1 + 1e-9), `${levels} ${i}: ${off}, ${allowed}`);
      });
      assert.equal(channels.length, scene.channels.length);
      channels.forEach(({ values, ...channel }, k) => {
        const { values: wanted, ...others } = scene.channels[k];
        assert.deepEqual(channel, others);
        values.forEach((v, i) => assert.ok(Math.abs(v - wanted[i]) <= 3, `${k} ${i}`));
      });
      assert.equal(contacts.length, scene.contacts.length);
      assert.deepEqual(series.columns, scene.series.columns);
      series.columns.forEach((name, c) => {
        const column = scene.series.rows.map((row) => row[c]);
        const known = column.filter((value) => value !== null);
        const range = Math.max(...known) - Math.min(...known);
        series.rows.forEach((row, r) => {
          if (column[r] === null) assert.equal(row[c], null);
          else assert.ok(Math.abs(row[c] - column[r]) <= range / 8192, `${name} ${r}`);
        });
      });
    }
  const text = packed(bytes_of_scene(head));
  assert.deepEqual(
    new Uint8Array(inflateRawSync(bytes_of_letters(text))),
    bytes_of_scene(head),
  );
  const plain = readFileSync(join(directory, 'scenes/fixture_head.json')).length;
  assert.ok(text.length < 0.35 * plain, `${text.length} of ${plain} bytes`);
});

// A force of half of a 128th of the usual one, or less in each direction, is left out.
test('Contacts_KeepPlaceAndForceOfEveryArrow', () => {
  const box = { low: [-1, 0, 0], high: [1, 0.5, 0] };
  const large = Array.from({ length: 40 }, (_, i) => [
    ...[Math.sin(i), 0.25 + 0.2 * Math.cos(3 * i), 0],
    ...[1e-5 * Math.cos(i), -2e-5, 1e-6 * i],
  ]);
  const small = [0.5, 0.1, 0, 1e-9, 0, 0];
  const frames = [large.flat(), [], [...small, ...large[7]]];
  const { header, bytes } = bytes_of_contacts(frames, box);
  const { contacts, usual_force_n: usual } = contacts_of_bytes(bytes, header, box);
  const sizes = [...large, small, large[7]].map((c) => Math.hypot(...c.slice(3)));
  assert.equal(usual, sizes.sort((a, b) => a - b)[Math.floor(0.95 * 41)]);
  assert.deepEqual(contacts.map(({ length }) => length / 6), [40, 0, 1]);
  const split = (flat) =>
    Array.from({ length: flat.length / 6 }, (_, i) => flat.slice(6 * i, 6 * i + 6));
  for (const [found, wanted] of [
    [split(contacts[0]), large],
    [split(contacts[2]), [large[7]]],
  ])
    for (const contact of wanted)
      assert.ok(
        found.some((other) =>
          other.every((x, c) =>
            Math.abs(x - contact[c]) <= (c < 3 ? 1.001 / 1024 : 0.501 * (usual / 128)),
          ),
        ),
        `${contact}`,
      );
  assert.equal(bytes_of_contacts(undefined, box), undefined);
});

test('Pose_TakesTheShorterWayBetweenQuaternions', () => {
  const half = Math.SQRT1_2;
  const poses = [
    [0, 0, 0, 1, 0, 0, 0],
    [2, 0, 0, -half, 0, 0, -half], // a quarter turn about z, written with the other sign
  ];
  const { centre, axes } = pose_at({ poses }, 0.5);
  assert.deepEqual(centre, [1, 0, 0]);
  const eighth = [half, half, 0];
  axes[0].forEach((x, i) => assert.ok(Math.abs(x - eighth[i]) < 1e-15));
});

// The eye looks along +y from (0, -d, 0); a point is hidden where a body stands between.
const view = (() => {
  const camera = new Camera([0, 0, 0], 1);
  camera.look('front');
  return camera.projection(400, 300);
})();
const body_of = (shape, half_axes_m, pose = [0, 0, 0, 1, 0, 0, 0]) =>
  bodies_at([{ shape, half_axes_m, poses: [pose] }], 0, view, {
    middle: [0, 0, 0],
    radius: 1,
  })[0];

test('Bodies_HideWhatIsBehindThem', () => {
  const ball = body_of('ellipsoid', [0.5, 0.2, 0.1]);
  assert.equal(ball.hides([0, 1, 0]), true);
  assert.equal(ball.hides([0.1, 0.05, 0.02]), true); // inside
  assert.equal(ball.hides([0, -1, 0]), false);
  assert.equal(ball.hides([0, -0.2, 0]), false); // on the face that looks at the eye
  assert.equal(ball.hides([0, 0.2, 0]), true); // on the other
  assert.equal(ball.hides([0, 0.2, 0.2]), false);
  assert.equal(ball.hides([0.4, 0.2, 0]), true);

  const capsule = body_of('capsule', [0.1, 0.1, 0.5]);
  assert.equal(capsule.hides([0, 0.3, 0.55]), true);
  assert.equal(capsule.hides([0, 0.3, -0.55]), true);
  assert.equal(capsule.hides([0.3, 0.3, 0]), false);
  assert.equal(capsule.hides([0, -0.3, 0]), false);
  assert.equal(capsule.hides([0, 0.3, 0.8]), false);
  // A quarter turn about y lays its axis, local z, along x.
  const lying = [0, 0, 0, Math.SQRT1_2, 0, Math.SQRT1_2, 0];
  const across = body_of('capsule', [0.1, 0.1, 0.5], lying);
  assert.equal(across.hides([0.3, 0.3, 0]), true);
  assert.equal(across.hides([0, 0.3, 0.3]), false);

  const raised = body_of('plane', undefined, [0, 0, -0.5, 1, 0, 0, 0]);
  assert.equal(raised.hides([0, 0, -0.6]), true);
  assert.equal(raised.hides([0, 0, -0.4]), false);
});

// A ball of radius r at distance d is seen under the angle asin(r/d).
test('Ball_IsOutlinedAtItsTrueAngle', () => {
  const { outline } = body_of('sphere', [0.3, 0.3, 0.3]);
  const wanted = view.scale * Math.tan(Math.asin(0.3 / view.distance));
  for (const { x, y } of outline) {
    const radius = Math.hypot(x - 200, y - 150);
    assert.ok(Math.abs(radius - wanted) < 1e-9 * wanted, `${radius} ${wanted}`);
  }
  const { x, y, depth } = project(view, [0, 0, 0.1]);
  assert.ok(Math.abs(x - 200) < 1e-9 && y < 150 && Math.abs(depth - view.distance) < 1e-12);
});

test('View_SurvivesTheAddress', () => {
  const camera = new Camera([1, 2, 3], 0.2);
  camera.turn(37, 11);
  camera.magnify(1.7);
  camera.move(12, -5, camera.projection(400, 300));
  const other = new Camera([1, 2, 3], 0.2);
  other.read(camera.text());
  assert.equal(other.text(), camera.text());
  other.read('nonsense');
  other.read('1,2');
  assert.equal(other.text(), camera.text());
});
