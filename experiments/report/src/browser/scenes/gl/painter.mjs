// The picture of bodies and strands by WebGL 2, drawn on a canvas of its own. For each
// picture: opacity of the hair as the light sees it, then where every point is seen and how
// it is lit, bodies, and the segments as ribbons from the back to the front.
import * as twgl from 'twgl.js';
import { brown_hair, tables_of } from '../../../hair/fibre.mjs';
import { cross } from '../camera.mjs';
import { linear, on_hair, towards_light } from '../light.mjs';
import { unit_ball } from './ball.mjs';
import { Buffers } from './buffers.mjs';
import { points_wide, programs } from './shaders.mjs';

const map_size = 256; // texels of the light's map across the scene
const layer_ends = [0.012, 0.035, 0.09, 0.25]; // parts of the scene's diameter
const lift = 0.002; // of the scene's radius, by which strands are drawn out of bodies
const grid_cells = 16; // of a plane
const plane_reach = 1.6; // radii of the scene

const unit = (v) => v.map((x) => x / Math.hypot(...v));

export class Painter {
  // Undefined where there is no WebGL 2, or it cannot draw into textures of floats.
  static create() {
    const canvas = document.createElement('canvas');
    const gl = canvas.getContext('webgl2', {
      alpha: false,
      antialias: false,
      depth: false,
    });
    if (!gl?.getExtension('EXT_color_buffer_float')) return undefined;
    return new Painter(canvas, gl);
  }

  #buffers = new Map(); // of curves
  #programs = {}; // compiled when first used

  constructor(canvas, gl) {
    this.canvas = canvas;
    this.gl = gl;
    this.lost = false;
    const named = gl.getExtension('WEBGL_debug_renderer_info');
    const renderer = named ? gl.getParameter(named.UNMASKED_RENDERER_WEBGL) : '';
    this.software = /SwiftShader|llvmpipe|Software|Basic Render/i.test(renderer);
    canvas.addEventListener('webglcontextlost', () => (this.lost = true));
    const target = { internalFormat: gl.RGBA16F, minMag: gl.NEAREST };
    const depth = { internalFormat: gl.DEPTH_COMPONENT24, minMag: gl.NEAREST };
    this.picture = twgl.createFramebufferInfo(gl, [target, depth], 16, 16);
    this.picture_targets = [target, depth];
    this.depth_map = twgl.createFramebufferInfo(
      gl,
      [{ internalFormat: gl.DEPTH_COMPONENT24, minMag: gl.NEAREST,
         attachmentPoint: gl.DEPTH_ATTACHMENT }],
      map_size,
      map_size,
    ); // prettier-ignore
    this.layers = twgl.createFramebufferInfo(
      gl,
      [{ internalFormat: gl.RGBA16F, minMag: gl.LINEAR }],
      map_size,
      map_size,
    );
    this.nothing = gl.createVertexArray();
    this.ramp = twgl.createTexture(gl, {
      width: 256, height: 1, minMag: gl.LINEAR, wrap: gl.CLAMP_TO_EDGE, auto: false,
    }); // prettier-ignore
  }

  // Tables of the hair, made when hair is first drawn.
  #hair() {
    const { gl } = this;
    if (this.tables === undefined) {
      const table = ({ width, height, data }) =>
        twgl.createTexture(gl, {
          internalFormat: gl.RGBA16F, format: gl.RGBA, type: gl.FLOAT, width, height,
          src: data, minMag: gl.LINEAR, wrap: gl.CLAMP_TO_EDGE, auto: false,
        }); // prettier-ignore
      const { through, back, along, albedo } = tables_of(brown_hair);
      this.tables = {
        through: table(through),
        back: table(back),
        along: table(along),
        albedo,
      };
    }
    return this.tables;
  }

  #program(name) {
    return (this.#programs[name] ??= twgl.createProgramInfo(this.gl, programs[name]));
  }

  #ball() {
    if (this.ball === undefined) {
      const { gl } = this;
      const { ball, indices } = unit_ball();
      const arrays = twgl.createBufferInfoFromArrays(gl, {
        ball: { numComponents: 4, data: new Float32Array(ball) },
        indices: { numComponents: 3, data: new Uint16Array(indices) },
      });
      this.ball = twgl.createVertexArrayInfo(gl, this.#program('bodies'), arrays);
    }
    return this.ball;
  }

  #of(curves) {
    if (!this.#buffers.has(curves))
      this.#buffers.set(curves, new Buffers(this.gl, curves));
    return this.#buffers.get(curves);
  }

  // These curves are not drawn again.
  forget(curves) {
    this.#buffers.get(curves)?.free();
    this.#buffers.delete(curves);
  }

  #use(name, target, size, ...uniforms) {
    const { gl } = this;
    gl.bindFramebuffer(gl.FRAMEBUFFER, target);
    gl.viewport(0, 0, ...size);
    const program = this.#program(name);
    gl.useProgram(program.program);
    twgl.setUniforms(program, ...uniforms);
  }

  // `view` in pixels of the canvas; `style`: what Pane's style() gives. The picture is on
  // this.canvas until the next is drawn.
  draw(curves, bodies, view, style) {
    const { gl, canvas } = this;
    const { width, height } = view;
    if (canvas.width !== width) canvas.width = width;
    if (canvas.height !== height) canvas.height = height;
    if (this.picture.width !== width || this.picture.height !== height)
      twgl.resizeFramebufferInfo(gl, this.picture, this.picture_targets, width, height);
    const size = [width, height];
    const { middle, radius } = style;
    const { right, up, forward, distance } = view;
    const light_out = towards_light(view);
    const light_right = unit(cross(up, light_out));
    const [near, far] = [0.02 * distance, 20 * distance];
    const all = {
      eye: view.eye, forward, right, up, size, scale: view.scale, distance_m: distance,
      depths: [(far + near) / (far - near), (-2 * far * near) / (far - near)],
      middle, radius, light: light_out, light_right,
      light_up: cross(light_out, light_right),
      layers: layer_ends, shadow: style.fibres ? on_hair.shadow : 0,
      first_depth: this.depth_map.attachments[0], opacity: this.layers.attachments[0],
      background: linear(style.background),
    }; // prettier-ignore
    const buffers = this.#of(curves);
    const count = buffers.update(curves, view);

    gl.disable(gl.BLEND);
    if (style.fibres) this.#light(buffers, all, style);
    this.#points(curves, buffers, all, style);

    gl.enable(gl.DEPTH_TEST);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.picture.framebuffer);
    gl.clearColor(...all.background, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    this.#bodies(
      bodies.filter(({ shape }) => shape !== 'plane'),
      all,
      style,
    );
    gl.depthMask(false);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    const planes = bodies.filter(({ shape }) => shape === 'plane');
    // The eye looks on the planes before it through those strands that lie above them.
    const above = ({ centre, axes }) =>
      [0, 1, 2].reduce((sum, i) => sum + (view.eye[i] - centre[i]) * axes[2][i], 0) > 0;
    this.#planes(planes.filter(above), all, style);
    this.#use('ribbons', this.picture.framebuffer, size, all, {
      seen: buffers.points.attachments[0], lit: buffers.points.attachments[1],
      width: style.width, diameter: style.diameter, rim: style.rim, lift: lift * radius,
    }); // prettier-ignore
    gl.bindVertexArray(buffers.ribbons.array);
    gl.drawElements(gl.TRIANGLES, 6 * count, gl.UNSIGNED_INT, 0);
    this.#planes(
      planes.filter((plane) => !above(plane)),
      all,
      style,
    );
    gl.depthMask(true);
    gl.disable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
    this.#use('shown', null, size, { picture: this.picture.attachments[0] });
    this.#cover();
  }

  #cover() {
    this.gl.bindVertexArray(this.nothing);
    this.gl.drawArrays(this.gl.TRIANGLES, 0, 3);
  }

  // Depth of the first hair that the light meets, then what lies above each layer's end.
  #light(buffers, all, { width, diameter, radius }) {
    const { gl } = this;
    const size = [map_size, map_size];
    const drawn = Math.max((width * all.distance_m) / all.scale, diameter);
    gl.enable(gl.DEPTH_TEST);
    this.#use('light_depth', this.depth_map.framebuffer, size, all, {
      places: buffers.places,
    });
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.bindVertexArray(buffers.lines.array);
    gl.drawElements(gl.LINES, 2 * buffers.segments, gl.UNSIGNED_INT, 0);
    gl.disable(gl.DEPTH_TEST);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE);
    this.#use('light_layers', this.layers.framebuffer, size, all, {
      places: buffers.places,
      covers: Math.min(1, (drawn * map_size) / (2 * radius)),
    });
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT);
    gl.drawElements(gl.LINES, 2 * buffers.segments, gl.UNSIGNED_INT, 0);
    gl.disable(gl.BLEND);
  }

  #points(curves, buffers, all, style) {
    const { gl } = this;
    const ramp = new Uint8Array(4 * 256);
    for (let i = 0; i < 256; ++i)
      ramp.set([...style.ramp(i / 255).map(Math.round), 255], 4 * i);
    twgl.setTextureFromArray(gl, this.ramp, ramp, {
      width: 256, height: 1, minMag: gl.LINEAR, wrap: gl.CLAMP_TO_EDGE, auto: false,
    }); // prettier-ignore
    this.#use('points', buffers.points.framebuffer, [points_wide, buffers.rows], all, {
      places: buffers.places, ends: buffers.ends, ramp: this.ramp, count: curves.size,
      fibres: style.fibres, ...this.#hair(), sun: on_hair.sun, sky: on_hair.sky, deep: on_hair.deep,
    }); // prettier-ignore
    this.#cover();
  }

  #bodies(bodies, all, { body }) {
    const { gl } = this;
    const ball = this.#ball();
    gl.bindVertexArray(ball.vertexArrayObject);
    for (const { shape, half_axes_m: half, centre, axes } of bodies) {
      const capsule = shape === 'capsule';
      this.#use('bodies', this.picture.framebuffer, all.size, all, {
        axes: axes.flat(), centre, apart: capsule ? half[2] : 0,
        half_axes: capsule ? [half[0], half[0], half[0]] : half,
        bright: linear(body.light), dark: linear(body.dark), line: linear(body.line),
        line_part: 0.25, shown: capsule ? [0, 0, 1] : [1, 1, 1],
      }); // prettier-ignore
      twgl.drawBufferInfo(gl, ball);
    }
  }

  #planes(planes, all, { body, middle, radius }) {
    const { gl } = this;
    gl.bindVertexArray(this.nothing);
    for (const {
      centre,
      axes: [a, b, up],
    } of planes) {
      const height = [0, 1, 2].reduce(
        (sum, i) => sum + (middle[i] - centre[i]) * up[i],
        0,
      );
      const reach = plane_reach * radius;
      this.#use('planes', this.picture.framebuffer, all.size, all, {
        corner: middle.map((m, i) => m - height * up[i] - reach * (a[i] + b[i])),
        along_a: a.map((x) => 2 * reach * x), along_b: b.map((x) => 2 * reach * x),
        floor_colour: [...linear(body.floor), 0.45], line_colour: [...linear(body.line), 0.16],
        cells: grid_cells,
      }); // prettier-ignore
      gl.drawArrays(gl.TRIANGLE_STRIP, 0, 4);
    }
  }
}
