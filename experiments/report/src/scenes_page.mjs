// The "Scenes" tab: places and controls; src/browser/scenes/ brings them to life.
import { arrays_of } from './browser/scenes/data.mjs';
import { escape_html, format_number } from './format.mjs';
import { packed } from './packed.mjs';
import { bytes_of_scene } from './packing.mjs';

const missing = `<p class="missing"><strong>No scene is there yet.</strong> Scenes are the
files <code>results/scenes/*.json</code>, which <code>build/release/experiments/simulate</code>
writes; run it, then <code>./tress report</code>.</p>`;

const speeds = [0.1, 0.25, 0.5, 1, 2];

const options_html = (list, chosen) =>
  list
    .map(
      ([value, text]) =>
        `<option value="${escape_html(value)}"${value === chosen ? ' selected' : ''}>` +
        `${escape_html(text)}</option>`,
    )
    .join('');

const select_html = (id, label, list = [], chosen = undefined) =>
  `<label>${label} <select id="${id}">${options_html(list, chosen)}</select></label>`;

const views = [
  ['front', 'Front'],
  ['side', 'Side'],
  ['top', 'Top'],
  ['home', 'Whole scene'],
];

function player_html(scenes) {
  return `<div class="card scene" id="scene">
<div class="scene-tools">
${select_html(
  'scene-name',
  'Scene',
  scenes.map(({ scene, title }) => [scene, `${scene}: ${title}`]),
)}
${select_html('scene-beside', 'Next to it')}
${select_html('scene-colour', 'Colour')}
${select_html('scene-forces', 'Forces', [
  ['hidden', 'hidden'],
  ['arrows', 'as arrows'],
])}
${select_html('scene-strands', 'Strands', [
  ['all', 'all'],
  ['guides', 'simulated only'],
])}
<span class="views" role="group" aria-label="View">${views
    .map(([id, text]) => `<button type="button" data-view="${id}">${text}</button>`)
    .join('')}<button type="button" id="scene-full">Fill window</button></span>
</div>
<div class="stage">
<canvas id="scene-canvas" tabindex="0" role="img" aria-label="A scene in 3D" aria-describedby="scene-caption"></canvas>
<div class="stage-title" id="scene-title"></div>
<div class="colour-bar" id="scene-bar" hidden><span class="bar-name"></span>
<span class="bar-low"></span><span class="bar-ramp"></span><span class="bar-high"></span></div>
<div class="stage-time" id="scene-time"></div>
</div>
<div class="transport">
<button type="button" id="scene-play" aria-pressed="false">Play</button>
<label><input type="checkbox" id="scene-loop"> Loop</label>
<input type="range" id="scene-scrub" min="0" value="0" step="1" aria-label="Frame">
${select_html(
  'scene-speed',
  'Speed',
  speeds.map((speed) => [String(speed), `${format_number(speed)}x`]),
  '1',
)}
</div>
<p class="note" id="scene-caption"></p>
<p class="note keys">Drag turns, wheel or two fingers zoom, shift-drag or two fingers move.
Space plays, arrow keys step a frame (with shift ten), Home and End go to the ends, Escape
leaves the full window.</p>
</div>
<h2>Time series</h2>
<p class="note">One plot for every column; the line marks the frame shown above, a click
goes to its time.</p>
<div class="series" id="scene-series"></div>`;
}

export const scenes_html = (scenes) =>
  `<h1>Scenes</h1>\n${scenes.length === 0 ? missing : player_html(scenes)}`;

// One script element for each scene, so that the page reads only those it shows.
export const scene_data_html = (scenes, levels) =>
  scenes
    .map(
      (scene) =>
        `<script type="text/plain" data-scene="${escape_html(scene.scene)}">` +
        `${packed(bytes_of_scene(arrays_of(scene), levels))}</script>`,
    )
    .join('\n');
