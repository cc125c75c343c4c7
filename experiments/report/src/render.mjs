// Figures as SVG text in Node, from the same specs the page draws.
import * as vega from 'vega';
import * as vega_lite from 'vega-lite';
import { expressionInterpreter } from 'vega-interpreter';
import { figures, figure_spec } from '../figures/all.mjs';
import { dark_theme, paper_theme, paper_width, vega_config } from '../figures/common.mjs';

export const sources = TRESS_SOURCES;

// Node has no canvas to measure text with, and Vega's own estimate is 0.8 of the font size
// a letter: legends spread and names are cut short. Widths of DejaVu Sans over the font
// size, the widest of the usual fonts, so that nothing is narrower in another.
const letter_widths = [
  [/[ijl'|!.,:;I]/u, 0.32],
  [/[ftr()[\] -]/u, 0.4],
  [/[mwMW%@]/u, 0.95],
  [/[A-HJ-LN-VX-Z]/u, 0.71],
];
const letter_width = (letter) =>
  letter_widths.find(([letters]) => letters.test(letter))?.[1] ?? 0.62;
vega.textMetrics.width = ({ fontSize = 11, fontWeight = 400 }, text) => {
  const bold = fontWeight === 'bold' || fontWeight >= 600 ? 1.1 : 1;
  const letters = [...String(text ?? '').trim()];
  return bold * fontSize * letters.reduce((sum, c) => sum + letter_width(c), 0);
};

// Vega reports what fails while it draws to a logger and goes on.
class Errors {
  first = undefined;
  error(...args) {
    this.first ??= args.find((arg) => arg instanceof Error) ?? new Error(args.join(' '));
    return this;
  }
  warn = () => this;
  info = () => this;
  debug = () => this;
  level = () => this;
}

// Colours of the theme in the file change where the reader prefers dark.
const dark_rules = Object.entries(paper_theme)
  .flatMap(([name, colour]) =>
    ['fill', 'stroke'].map(
      (property) => `.tress [${property}="${colour}"]{${property}:${dark_theme[name]}}`,
    ),
  )
  .join('');

const escaped = (text) =>
  text.replace(/[&<>]/g, (c) => ({ '&': '&amp;', '<': '&lt;', '>': '&gt;' })[c]);

// What a reader that sees no picture is told, and the dark theme.
const with_head = (svg, headline, description) =>
  svg.replace(
    /^<svg\b([^>]*?)class="([^"]*)"([^>]*)>/,
    (_, before, of, after) =>
      `<svg${before}class="tress ${of}"${after}><title>${escaped(headline)}</title>` +
      `<desc>${escaped(description)}</desc>` +
      `<style>@media (prefers-color-scheme:dark){${dark_rules}}</style>`,
  );

// The figure as SVG text, undefined when the tables hold nothing to draw.
async function render(figure, tables) {
  const spec = figure_spec(figure, tables, { width: paper_width, theme: paper_theme });
  if (spec === undefined) return undefined;
  const logger = new Errors();
  const config = vega_config(paper_theme);
  const compiled = vega_lite.compile(spec, { config, logger }).spec;
  const view = new vega.View(vega.parse(compiled, null, { ast: true }), {
    renderer: 'none',
    expr: expressionInterpreter,
    logger,
  });
  const svg = await view.toSVG();
  view.finalize();
  if (logger.first !== undefined) throw logger.first;
  return `${with_head(svg, figure.headline(tables), spec.description)}\n`;
}

// [{id, svg}] for every figure the tables can fill; another one is a warning.
export async function render_figures(tables, warnings) {
  const out = [];
  for (const figure of figures) {
    try {
      const svg = await render(figure, tables);
      if (svg !== undefined) out.push({ id: figure.id, svg });
    } catch (error) {
      warnings.failed(`${figure.table}.csv`, `figure ${figure.id}`, error);
    }
  }
  return out;
}
