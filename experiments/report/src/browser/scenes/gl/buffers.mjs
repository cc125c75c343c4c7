import * as twgl from 'twgl.js';
import { Order } from '../order.mjs';
import { points_wide } from './shaders.mjs';

// Arrays on the graphics processor for the curves of one scene.
export class Buffers {
  constructor(gl, curves) {
    this.gl = gl;
    this.order = new Order(curves);
    this.rows = Math.ceil(curves.size / points_wide);
    const texture = (internalFormat, src) =>
      twgl.createTexture(gl, {
        internalFormat,
        width: points_wide,
        height: this.rows,
        minMag: gl.NEAREST,
        wrap: gl.CLAMP_TO_EDGE,
        auto: false,
        src,
      });
    const ends = new Uint8Array(points_wide * this.rows);
    for (let f = 0; f < curves.size; ++f) ends[f] = curves.first[f] + 2 * curves.last[f];
    this.ends = texture(gl.R8UI, ends);
    this.places = texture(gl.RGBA32F);
    this.staged = new Float32Array(4 * points_wide * this.rows);
    const target = (internalFormat) => ({ internalFormat, minMag: gl.NEAREST });
    this.points = twgl.createFramebufferInfo(
      gl,
      [target(gl.RGBA32F), target(gl.RGBA16F)],
      points_wide,
      this.rows,
    );
    // No attributes: a vertex is known by its index.
    [this.lines, this.ribbons] = [2, 6].map((indices) => {
      const array = gl.createVertexArray();
      const buffer = gl.createBuffer();
      gl.bindVertexArray(array);
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, 4 * indices * curves.size, gl.STREAM_DRAW);
      gl.bindVertexArray(null);
      return { array, buffer, data: new Uint32Array(indices * curves.size) };
    });
    const { data } = this.lines;
    let count = 0;
    for (let f = 0; f < curves.size; ++f)
      if (!curves.last[f]) data.set([f, f + 1], 2 * count++);
    this.segments = count;
    this.#send(this.lines, 2 * count);
  }

  #send({ array, data }, count) {
    const { gl } = this;
    gl.bindVertexArray(array);
    gl.bufferSubData(gl.ELEMENT_ARRAY_BUFFER, 0, data, 0, count);
  }

  // The curves as they are now; returns the number of segments before the eye.
  update(curves, view) {
    const { gl } = this;
    const count = this.order.sort(view);
    const { data } = this.ribbons;
    for (let o = 0, i = 0; o < count; ++o) {
      const v = 2 * this.order.segments[o];
      data[i++] = v;
      data[i++] = v + 1;
      data[i++] = v + 2;
      data[i++] = v + 2;
      data[i++] = v + 1;
      data[i++] = v + 3;
    }
    this.#send(this.ribbons, 6 * count);
    this.staged.set(curves.points);
    gl.bindTexture(gl.TEXTURE_2D, this.places);
    gl.texSubImage2D(
      gl.TEXTURE_2D, 0, 0, 0, points_wide, this.rows, gl.RGBA, gl.FLOAT, this.staged,
    ); // prettier-ignore
    return count;
  }

  free() {
    const { gl } = this;
    for (const texture of [this.ends, this.places, ...this.points.attachments])
      gl.deleteTexture(texture);
    gl.deleteFramebuffer(this.points.framebuffer);
    for (const { array, buffer } of [this.lines, this.ribbons]) {
      gl.deleteBuffer(buffer);
      gl.deleteVertexArray(array);
    }
  }
}
