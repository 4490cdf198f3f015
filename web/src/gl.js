// Draws blocks and joints by a graphics card (WebGL 2). Positions in css px, y down.

import { bytesOf, meshOf } from "./mesh.js";

const kVertex = `#version 300 es
in vec2 place; in vec4 colour; uniform vec2 size; out vec4 tint;
void main() { tint = colour; gl_Position = vec4(2.0 * place.x / size.x - 1.0, 1.0 - 2.0 * place.y / size.y, 0, 1); }`;
const kFragment = `#version 300 es
precision mediump float; in vec4 tint; out vec4 result;
void main() { result = vec4(tint.rgb * tint.a, tint.a); }`;

export class Painter {
  /** A painter on this canvas, null where the browser has no WebGL 2 or does it by software. */
  static on(canvas) {
    const trial = document.createElement("canvas").getContext("webgl2");  // a canvas keeps its first kind of context
    if (!trial) return null;
    const info = trial.getExtension("WEBGL_debug_renderer_info");
    const name = trial.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : trial.RENDERER);
    const lose = trial.getExtension("WEBGL_lose_context");
    if (lose) lose.loseContext();
    if (/swiftshader|llvmpipe|software|basic render/i.test(name)) return null;
    const gl = canvas.getContext("webgl2", { alpha: false, antialias: true, powerPreference: "high-performance" });
    return gl ? new Painter(canvas, gl) : null;
  }

  constructor(canvas, gl) {
    this.canvas = canvas;
    this.gl = gl;
    const program = gl.createProgram();
    for (const [kind, source] of [[gl.VERTEX_SHADER, kVertex], [gl.FRAGMENT_SHADER, kFragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error("no shaders");
    gl.useProgram(program);
    this.size_ = gl.getUniformLocation(program, "size");
    this.place_ = gl.getAttribLocation(program, "place");
    this.colour_ = gl.getAttribLocation(program, "colour");
    this.buffers_ = { place: gl.createBuffer(), colour: gl.createBuffer(), triangles: gl.createBuffer(), edges: gl.createBuffer(), quads: gl.createBuffer(), tints: gl.createBuffer() };
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    this.shapes_ = null;
  }

  begin(background) {
    const { gl, canvas } = this, [r, g, b] = bytesOf(background), ratio = window.devicePixelRatio || 1;
    const w = Math.round(canvas.clientWidth * ratio), h = Math.round(canvas.clientHeight * ratio);
    if (canvas.width !== w || canvas.height !== h) canvas.width = w, canvas.height = h;
    gl.viewport(0, 0, canvas.width, canvas.height);
    gl.clearColor(r / 255, g / 255, b / 255, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    gl.uniform2f(this.size_, canvas.clientWidth, canvas.clientHeight);
  }

  /** All blocks: places [2 x corners], bytes of colours [4 x corners]; outlines in one colour when it is given. */
  blocks(shapes, places, tints, outline) {
    const { gl, buffers_: b } = this;
    if (this.shapes_ !== shapes) {
      this.shapes_ = shapes;
      const { triangles, edges } = meshOf(shapes);
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, b.triangles);
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, triangles, gl.STATIC_DRAW);
      gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, b.edges);
      gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, edges, gl.STATIC_DRAW);
      this.triangles_ = triangles.length, this.edges_ = edges.length;
    }
    this.fill_(b.place, this.place_, places, 2, gl.FLOAT, false);
    this.fill_(b.colour, this.colour_, tints, 4, gl.UNSIGNED_BYTE, true);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, b.triangles);
    gl.drawElements(gl.TRIANGLES, this.triangles_, gl.UNSIGNED_INT, 0);
    if (!outline) return;
    gl.disableVertexAttribArray(this.colour_);
    gl.vertexAttrib4f(this.colour_, ...outline.map((v) => v / 255));
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, b.edges);
    gl.drawElements(gl.LINES, this.edges_, gl.UNSIGNED_INT, 0);
  }

  /** Triangles: places [2 x n], bytes of colours [4 x n]. */
  triangles(places, tints) {
    const { gl, buffers_: b } = this;
    if (!places.length) return;
    this.fill_(b.quads, this.place_, places, 2, gl.FLOAT, false);
    this.fill_(b.tints, this.colour_, tints, 4, gl.UNSIGNED_BYTE, true);
    gl.drawArrays(gl.TRIANGLES, 0, places.length / 2);
  }

  end() {}

  fill_(buffer, attribute, data, count, type, normalized) {
    const { gl } = this;
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, data, gl.STREAM_DRAW);
    gl.enableVertexAttribArray(attribute);
    gl.vertexAttribPointer(attribute, count, type, normalized, 0, 0);
  }
}
