// The text of the page: tabs, sections, findings, places for figures and tables.
import { cost_by_model_findings } from '../figures/cost_by_model.mjs';
import { family_findings } from '../figures/family.mjs';
import { descent_findings } from '../figures/block_descent.mjs';
import { map_findings } from '../figures/cosserat_map.mjs';
import { transport_findings } from '../figures/force_transport.mjs';
import { hard_findings } from '../figures/hard_cases.mjs';
import { model_step_findings } from '../figures/model_steps.mjs';
import { newest_findings } from '../figures/newest_methods.mjs';
import { nodal_step_findings } from '../figures/nodal_steps.mjs';
import { validation_findings } from '../figures/validation.mjs';
import { figures, figure_spec } from '../figures/all.mjs';
import { paper_theme, paper_width } from '../figures/common.mjs';
import { escape_html } from './format.mjs';
import { cost_findings } from './findings/cost.mjs';
import {
  boundary_sentences,
  drift_answer,
  drift_findings,
  recovery_sentences,
} from './findings/drift.mjs';
import { scaling_finding, scaling_findings } from './findings/scaling.mjs';
import { stability_answer, stability_findings } from './findings/stability.mjs';
import { swing_answer, swing_findings } from './findings/swing.mjs';
import { control_findings } from './findings/tolerance.mjs';
import { bdf_findings, work_answer, work_findings } from './findings/work.mjs';
import { checks_html, manifest_html } from './manifest.mjs';
import { scenes_html } from './scenes_page.mjs';
import {
  hard_summary,
  scaling_summary,
  stability_summary,
  swing_summary,
  validation_summary,
} from './summaries.mjs';
import { mixed_commits } from './provenance.mjs';
import { is_known, known_tables } from './tables.mjs';

// Each section: the question, its figure, what its findings are, its tables, and a table
// of selected numbers where it has one.
const none = () => [];
const measurements = [
  {
    figure: 'family',
    findings: family_findings,
    tables: ['family', 'family_summary', 'family_tolerance', 'family_tolerance_summary'],
  },
  { figure: 'drift_cost', findings: drift_findings, tables: ['constraint_drift'] },
  {
    figure: 'drift_heatmap',
    findings: boundary_sentences,
    tables: [],
  },
  {
    figure: 'drift_recovery',
    findings: ({ constraint_drift = [] }) => recovery_sentences(constraint_drift),
    tables: [],
  },
  { figure: 'work_precision', findings: work_findings, tables: ['work_precision'] },
  { figure: 'work_models', findings: none, tables: [] },
  { figure: 'tolerance', findings: control_findings, tables: [] },
  { figure: 'bdf_order', findings: bdf_findings, tables: [] },
  {
    figure: 'stability_limit',
    findings: stability_findings,
    summary: stability_summary,
    tables: ['stability_limit'],
  },
  { figure: 'model_steps', findings: model_step_findings, tables: [] },
  { figure: 'nodal_steps', findings: nodal_step_findings, tables: [] },
  {
    figure: 'scaling',
    findings: (objects) =>
      [scaling_finding(objects), ...scaling_findings(objects)].filter(Boolean),
    summary: scaling_summary,
    tables: ['scaling'],
  },
  {
    figure: 'swing',
    findings: swing_findings,
    summary: swing_summary,
    tables: ['other_simulators_swing'],
  },
  {
    figure: 'force_transport',
    findings: transport_findings,
    tables: ['force_transport'],
  },
  { figure: 'damping', findings: () => [], tables: ['damping'] },
  { figure: 'cost_of_gradient', findings: () => [], tables: ['cost_of_gradient'] },
  { figure: 'calibrate_points', findings: () => [], tables: ['calibrate_points'] },
  { figure: 'divided_heads', findings: () => [], tables: ['divided_heads'] },
  { figure: 'block_descent', findings: descent_findings, tables: ['block_descent'] },
  { figure: 'cosserat_map', findings: map_findings, tables: [] },
  { figure: 'newest_methods', findings: newest_findings, tables: [] },
];

// The three questions first, each a tab; then the measurements behind them.
const questions = [
  {
    name: 'validation',
    tab: 'Is it right?',
    heading: 'Is the physics right?',
    intro: `Each strand model is compared with published tests of slender rods, where the
      solution of the continuous rod is known from theory: the deflection of a hair under its weight, the load at which a rod buckles, the
      frequencies at which it swings. A correct model converges to the rod with more elements.`,
    sections: [
      {
        figure: 'validation',
        findings: validation_findings,
        summary: validation_summary,
        tables: ['validation'],
      },
      { figure: 'validation_tests', findings: none, tables: [] },
      { figure: 'validation_orders', findings: none, tables: [] },
    ],
  },
  {
    name: 'hard',
    tab: 'What survives?',
    heading: 'What survives a hard case?',
    intro: `Situations that break hair simulators, each with a physical criterion: no energy gain, no point
      faster than its drive allows, no penetration. A run is stable when no bound breaks; finite numbers are not
      enough. It is accurate when it also agrees with a reference.`,
    sections: [
      { figure: 'hard_cases_summary', findings: none, tables: [] },
      {
        figure: 'hard_cases',
        findings: hard_findings,
        summary: hard_summary,
        tables: ['hard_cases'],
      },
    ],
  },
  {
    name: 'cost',
    tab: 'What does accuracy cost?',
    heading: 'What does accuracy cost in time?',
    intro: `For each scene and each target error, a search over model, integrator, number of elements and step finds the
      cheapest run that meets it. The error is total: against the continuous rod, on which two models of different families
      agree, not against a finer run of the same model.`,
    sections: [
      {
        figure: 'cost_of_accuracy',
        findings: cost_findings,
        tables: ['cost_of_accuracy'],
      },
      { figure: 'cost_choices', findings: none, tables: [] },
      { figure: 'cost_by_model', findings: cost_by_model_findings, tables: [] },
    ],
  },
];

// A number and its unit stay on one line; ids stand in backticks.
const prose_html = (text) =>
  escape_html(text)
    .replace(
      /(?<![\w.#`])\d[\d.]*(?:e-?\d+)?(?![\w])(?: (?:ms|µs|m|s|%|1\/s²)(?![\w/]))?/g,
      '<span class="number">$&</span>',
    )
    .replace(/`([^`]+)`/g, '<code>$1</code>');

const one_line = (text) => text.replace(/\s+/g, ' ').trim();

function missing_html(name, problem) {
  const { command, program } = known_tables[name];
  if (problem !== undefined)
    return `<p class="missing"><strong>Left out.</strong> ${escape_html(problem)}</p>`;
  return (
    `<p class="missing"><strong>${name}.csv is not there yet.</strong> Produce it with ` +
    `<code>${command}</code>, or alone with <code>build/release/experiments/${program} --out ` +
    `results/${name}.csv</code>, then <code>./tress report</code>.</p>`
  );
}

const table_html = (name, title, rows) =>
  `<details class="data" data-table="${escape_html(name)}"><summary>${escape_html(title)}: ` +
  `${rows} row${rows === 1 ? '' : 's'} (${escape_html(name)}.csv)</summary></details>`;

const list_html = (sentences, visible = 8) => {
  const item = (sentence) => `<li>${prose_html(sentence)}</li>`;
  if (sentences.length === 0) return '';
  const rest = sentences.slice(visible);
  return (
    `<ul class="findings">${sentences.slice(0, visible).map(item).join('')}</ul>` +
    (rest.length > 0
      ? `<details class="more"><summary>${rest.length} more findings</summary>` +
        `<ul class="findings">${rest.map(item).join('')}</ul></details>`
      : '')
  );
};

const figure_html = (figure) => {
  const caption_id = `${figure.id}-caption`;
  return (
    `<figure class="card"><div class="plot" id="plot-${figure.id}" data-figure="${figure.id}" ` +
    `aria-describedby="${caption_id}"></div><figcaption id="${caption_id}">` +
    `${escape_html(one_line(figure.caption))} <span class="tools" data-tools="${figure.id}">` +
    '</span></figcaption></figure>'
  );
};

function section_html(section, { tables, objects, warnings }) {
  const figure = figures.find(({ id }) => id === section.figure);
  const present = figure.table in tables;
  const guard = (what, make, otherwise) =>
    warnings.guard(`${figure.table}.csv`, what, make, otherwise);
  const look = { width: paper_width, theme: paper_theme };
  const drawn =
    present &&
    guard(`figure ${figure.id}`, () => figure_spec(figure, objects, look), undefined);
  const body = !present
    ? missing_html(figure.table, warnings.of(figure.table))
    : drawn === undefined
      ? `<p class="missing">${figure.table}.csv holds no rows for this figure.</p>`
      : figure_html(figure);
  const listed = section.tables.flatMap((name) => {
    if (name in tables)
      return [table_html(name, known_tables[name].title, tables[name].rows.length)];
    const problem = warnings.of(name);
    return name === figure.table || (known_tables[name].optional && problem === undefined)
      ? []
      : [missing_html(name, problem)];
  });
  return (
    `<section id="${figure.id}"><h2>${escape_html(figure.title)}</h2>\n` +
    `${list_html(guard('its findings', () => section.findings(objects), []))}\n${body}\n` +
    `${guard('its summary', () => section.summary?.(objects), undefined) ?? ''}\n` +
    `${listed.join('\n')}</section>`
  );
}

const nav_html = (sections, of) =>
  `<nav aria-label="Sections of: ${escape_html(of)}">${sections
    .map(({ figure }) => figures.find(({ id }) => id === figure))
    .map(({ id, title }) => `<a href="#${id}">${escape_html(title)}</a>`)
    .join('')}<a href="#made">How this was made</a></nav>`;

// A table that is optional, absent and no cause of a warning has no section.
const shown = (sections, { tables, warnings }) =>
  sections.filter(({ figure }) => {
    const { table } = figures.find(({ id }) => id === figure);
    return table in tables || !known_tables[table].optional || warnings.of(table) !== undefined;
  });

function question_html({ heading, intro, sections }, contents) {
  const checked = sections
    .flatMap((section) => section.tables)
    .map((name) => checks_html(name, contents.tables[name]?.manifest))
    .join('');
  return [
    `<h1>${heading}</h1>\n<p>${escape_html(one_line(intro))}</p>` +
      `${sections.length > 1 ? nav_html(sections, heading) : ''}`,
    ...sections.map((section) => section_html(section, contents)),
    checked === '' ? '' : `<section><h2>What the run itself checked</h2>${checked}</section>`,
  ].join('\n');
}

function header_html({ tables, objects, warnings }) {
  const answer = (name, make) =>
    prose_html(
      warnings.guard(`${name}.csv`, 'the answer', () => make(objects), undefined) ??
        `No answer yet: ${name}.csv is missing or holds no finished runs.`,
    );
  const mixed = mixed_commits(tables);
  return `<h1>Constraint drift, stable steps, and the price of accuracy</h1>
<dl class="answers">
<dt>How far do constraints drift, and what does stopping the drift cost?</dt>
<dd id="answer-drift">${answer('constraint_drift', drift_answer)}</dd>
<dt>What does accuracy cost in time, per integrator?</dt>
<dd id="answer-work">${answer('work_precision', work_answer)}</dd>
<dt>How large a time step does a strand bear?</dt>
<dd id="answer-stability">${answer('stability_limit', stability_answer)}</dd>
<dt>How long does a strand take at a stated error, and how long do other simulators?</dt>
<dd id="answer-swing">${answer('work_precision', swing_answer)}</dd>
</dl>
<p class="note">Every sentence with a number on this page is computed from the tables below.</p>
${mixed === '' ? '' : `<p class="note" id="mixed-commits">${escape_html(mixed)}</p>`}
${nav_html(shown(measurements, { tables, warnings }), 'Measurements')}`;
}

const tab_html = (name, text, selected) =>
  `<button type="button" role="tab" id="tab-${name}" aria-controls="panel-${name}" ` +
  `aria-selected="${selected}"${selected ? '' : ' tabindex="-1"'}>${text}</button>`;

const panel_html = (name, content, attribute = '') =>
  `<div role="tabpanel" id="panel-${name}" aria-labelledby="tab-${name}"${attribute}>\n` +
  `${content}\n</div>`;

// What was left out, above all tabs.
function warnings_html({ list }) {
  if (list.length === 0) return '';
  return (
    '<aside class="missing" aria-label="What is left out"><p>Not everything could be used:</p><ul>' +
    `${list.map(({ text }) => `<li>${escape_html(text)}</li>`).join('')}</ul></aside>`
  );
}

// `tables` as load_results returns them, `objects` the same rows as objects, `scenes` as
// load_scenes returns them, `warnings` what was left out so far, added to.
export function body_html(tables, objects, scenes, warnings) {
  const contents = { tables, objects, warnings };
  const panels = [
    ...questions.map((question) => ({
      ...question,
      html: question_html(question, contents),
    })),
    { name: 'measured', tab: 'Measurements', html: measured_html(contents) },
    { name: 'scenes', tab: 'Scenes', html: scenes_html(scenes) },
  ];
  return [
    '<header class="tabs"><span class="kicker">tress report</span><div role="tablist" ' +
      `aria-label="Parts of the report">` +
      `${panels.map(({ name, tab }, i) => tab_html(name, tab, i === 0)).join('')}</div></header>`,
    '<main>',
    warnings_html(warnings),
    ...panels.map(({ name, html }, i) => panel_html(name, html, i === 0 ? '' : ' hidden')),
    '</main>',
  ].join('\n');
}

function measured_html(contents) {
  const { tables, warnings } = contents;
  const extra = Object.keys(tables).filter((name) => !is_known(name));
  return [
    header_html(contents),
    '<noscript><p class="missing">Scripts are off: the text stands, figures lie next to this file ' +
      'as SVG, tables as CSV.</p></noscript>',
    ...shown(measurements, contents).map((section) => section_html(section, contents)),
    extra.length > 0
      ? '<section id="other"><h2>Other tables</h2>' +
        `${extra.map((name) => table_html(name, name, tables[name].rows.length)).join('\n')}</section>`
      : '',
    `<section id="made"><h2>How this was made</h2>\n${manifest_html(tables, warnings)}\n</section>`,
  ].join('\n');
}
