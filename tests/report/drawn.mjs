// The figures of a results directory as specs and as SVG, and what is in them.
import { figure_spec, figures } from '../../experiments/report/figures/all.mjs';
import { paper_theme } from '../../experiments/report/figures/common.mjs';
import { load_results } from '../../experiments/report/src/load.mjs';
import { all_objects } from '../../experiments/report/src/objects.mjs';
import { Warnings } from '../../experiments/report/src/warnings.mjs';
import { render_figures } from '../../experiments/report/dist/render.mjs';

// [{id, spec, svg}] of every figure that the tables fill; drawn once, which takes seconds.
const known = new Map();
export function drawings(directory) {
  if (!known.has(directory)) known.set(directory, draw(directory));
  return known.get(directory);
}

async function draw(directory) {
  const warnings = new Warnings(directory, (text) => {
    throw new Error(text);
  });
  const objects = all_objects(load_results(directory, () => {}));
  const svgs = new Map(
    (await render_figures(objects, warnings)).map(({ id, svg }) => [id, svg]),
  );
  return figures
    .map((figure) => ({
      id: figure.id,
      spec: figure_spec(figure, objects, { width: 1000, theme: paper_theme }),
      svg: svgs.get(figure.id),
    }))
    .filter(({ spec }) => spec !== undefined);
}

export const size_of = (svg) => {
  const [, width, height] = /viewBox="0 0 ([\d.]+) ([\d.]+)"/.exec(svg);
  return { width: Number(width), height: Number(height) };
};

const is_hex = (value) => /^#[0-9a-f]{6}$/i.test(value ?? '');
const themed = new Set(Object.values(paper_theme));
export const is_themed = (colour) => themed.has(colour);

// Every scale of colours of a spec: {names, colours, shapes, cells}.
export function colour_scales(node, mark) {
  if (Array.isArray(node)) return node.flatMap((one) => colour_scales(one, mark));
  if (node === null || typeof node !== 'object') return [];
  const own = node.mark?.type ?? node.mark ?? mark;
  const { color, shape } = node.encoding ?? {};
  const range = color?.scale?.range;
  const scale = Array.isArray(range)
    ? [
        {
          names: color.scale.domain,
          colours: range,
          shapes: shape?.scale?.range ?? [],
          cells: ['rect', 'bar'].includes(own),
        },
      ]
    : [];
  const { data: _, encoding: __, ...inner } = node;
  return [...scale, ...Object.values(inner).flatMap((one) => colour_scales(one, own))];
}

// Colours of marks that are set without a scale, other than those of the theme.
export function fixed_colours(node) {
  if (Array.isArray(node)) return node.flatMap(fixed_colours);
  if (node === null || typeof node !== 'object') return [];
  const { data: _, encoding: __, ...inner } = node;
  const { type, color } = node.mark ?? {};
  return [
    ...(type !== 'text' && is_hex(color) && !is_themed(color) ? [color] : []),
    ...Object.values(inner).flatMap(fixed_colours),
  ];
}
