// Figures as SVG text in Node, from the same specs the page draws.
import * as vega from 'vega';
import * as vega_lite from 'vega-lite';
import { expressionInterpreter } from 'vega-interpreter';
import { figures, figure_spec } from '../figures/all.mjs';
import { paper_theme, vega_config } from '../figures/common.mjs';

export const sources = TRESS_SOURCES;
const paper_width = 1000;

// [{id, svg}] for every figure the tables can fill.
export async function render_figures(tables) {
  const out = [];
  for (const figure of figures) {
    const spec = figure_spec(figure, tables, { width: paper_width, theme: paper_theme });
    if (spec === undefined) continue;
    const compiled = vega_lite.compile(spec, { config: vega_config(paper_theme) }).spec;
    const view = new vega.View(vega.parse(compiled, null, { ast: true }),
      { renderer: 'none', expr: expressionInterpreter, logLevel: vega.Warn });
    out.push({ id: figure.id, svg: `${await view.toSVG()}\n` });
    view.finalize();
  }
  return out;
}
