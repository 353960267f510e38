// The same mechanism in space, turned by hand and lit. Seen from above it lies exactly where the flat picture has it, in the
// colours of the palette: light that a surface sends straight back counts as 1.
const VERTEX = `#version 300 es
in vec3 point; in vec3 normal;
uniform vec4 pose; uniform vec3 sight; uniform mat3 camera; uniform vec2 half_size; uniform float scale; uniform float depth;
out vec3 facing; out vec2 beside;
vec3 turned(vec3 v) { return vec3(pose.z * v.x - pose.w * v.y, pose.w * v.x + pose.z * v.y, v.z); }
void main() {
  vec3 seen = camera * (turned(scale * point) + vec3(pose.xy, 0.0) - vec3(sight.xy, 0.0)) * sight.z;
  facing = turned(normal);
  beside = seen.xy / max(half_size.x, half_size.y);
  gl_Position = vec4(seen.xy / half_size, -seen.z / depth, 1.0);
}`;
const FRAGMENT = `#version 300 es
precision highp float;
in vec3 facing; in vec2 beside; uniform mat3 camera; uniform vec3 light; uniform float metal; uniform float alpha; uniform vec3 mark; uniform vec2 number;
out vec4 colour;
// A studio: bright above, dim below, two windows and the dark edge of the table.
float studio(vec3 way) {
  float sky = mix(0.3, 1.0, smoothstep(-0.7, 0.55, way.z)) + 0.16 * (1.0 - way.z * way.z) * dot(way.xy, vec2(-0.6, 0.8)) - 0.22 * exp(-pow((way.z + 0.12) / 0.12, 2.0));
  return sky + 0.55 * smoothstep(0.82, 0.98, dot(way, normalize(vec3(-0.62, 0.55, 0.38)))) + 0.4 * smoothstep(0.88, 0.99, dot(way, normalize(vec3(0.8, -0.35, 0.1))));
}
void main() {
  vec3 n = normalize(facing), straight = transpose(camera) * vec3(0.0, 0.0, 1.0);
  float level = length(straight.xy); // 0 from above, where light comes straight back; else as from an eye at some distance
  vec3 eye = normalize(straight - 0.35 * level * (transpose(camera) * vec3(beside, 0.0)));
  if (dot(n, eye) < 0.0) n = -n;
  float grazing = 0.8 * pow(1.0 - dot(n, eye), 5.0), mirrored = studio(reflect(-eye, n));
  vec3 metallic = mix(light, vec3(1.0), grazing) * mirrored;
  float soft = mix(0.5, 1.0, smoothstep(-0.3, 0.75, n.z + 0.25 * dot(n.xy, vec2(-0.6, 0.8))));
  vec3 clear = light * soft + 0.5 * max(mirrored - 1.0, 0.0) + 0.4 * grazing;
  vec3 sent = mix(mix(clear, metallic, metal), mark, mark.x < 0.0 ? 0.0 : 0.5);
  vec3 low = 12.92 * sent, high = 1.055 * pow(max(sent, 1e-5), vec3(1.0 / 2.4)) - 0.055; // sRGB, IEC 61966-2-1
  colour = number.x + number.y > 0.0 ? vec4(number, 0.0, 1.0) : vec4(clamp(mix(low, high, step(0.0031308, sent)), 0.0, 1.0), 1.0) * alpha;
}`;
const TILT = 0.85, STEEPEST_TILT = 1.5; // radians from above: at first, at most
const FINE = 2; // pixels of the picture for one of the screen, at least
const linear = (colour) => [1, 3, 5].map((k) => { const c = parseInt(colour.slice(k, k + 2), 16) / 255; return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4; });

class Solids {
  constructor(data, canvas) {
    this.solids = data.solids; this.coils = data.coils.map((one) => new Coil(one));
    this.canvas = canvas; this.on = false; this.gl = null;
    this.level();
  }

  get any() { return Boolean(this.solids); }
  level() { this.tilt = TILT; this.yaw = 0.35; }
  orbit(dx, dy) { this.yaw += 0.01 * dx; this.tilt = clamp(this.tilt + 0.01 * dy, 0, STEEPEST_TILT); }

  // Show or hide; false where the browser has no WebGL 2.
  turn(on) {
    if (on && !this.gl && !this.start()) return false;
    this.on = on; this.canvas.hidden = !on;
    return true;
  }

  start() {
    const gl = this.canvas.getContext("webgl2", { antialias: true, premultipliedAlpha: true });
    if (!gl) return false;
    const program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, FRAGMENT]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text); gl.compileShader(shader); gl.attachShader(program, shader);
    }
    gl.bindAttribLocation(program, 0, "point"); gl.bindAttribLocation(program, 1, "normal");
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) return false;
    gl.useProgram(program); gl.enable(gl.DEPTH_TEST);
    this.at = Object.fromEntries(["pose", "sight", "camera", "half_size", "scale", "depth", "light", "metal", "alpha", "mark", "number"].map((name) => [name, gl.getUniformLocation(program, name)]));
    this.gl = gl;
    this.pieces = this.solids.pieces.map((piece) => {
      const faces = bytesOf(piece.faces), shape = this.shape(new Int16Array(bytesOf(piece.points).buffer), new Int8Array(bytesOf(piece.normals).buffer), gl.SHORT, gl.BYTE, faces);
      return { ...shape, body: piece.body, scale: piece.scale, light: linear(piece.fill), metal: piece.metal ? 1 : 0, kind: piece.wide ? gl.UNSIGNED_INT : gl.UNSIGNED_SHORT, count: faces.length / (piece.wide ? 4 : 2) };
    });
    return true;
  }

  // Vertices and triangles on the card; redrawn each frame where they bend.
  shape(points, normals, pointKind, normalKind, faces) {
    const { gl } = this, array = gl.createVertexArray(), stores = [gl.createBuffer(), gl.createBuffer(), gl.createBuffer()];
    gl.bindVertexArray(array);
    [[points, pointKind], [normals, normalKind]].forEach(([values, kind], k) => {
      gl.bindBuffer(gl.ARRAY_BUFFER, stores[k]); gl.bufferData(gl.ARRAY_BUFFER, values, gl.DYNAMIC_DRAW);
      gl.enableVertexAttribArray(k); gl.vertexAttribPointer(k, 3, kind, kind !== gl.FLOAT, 0, 0);
    });
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, stores[2]); gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, faces, gl.DYNAMIC_DRAW);
    return { array, stores };
  }

  // A strip that stands on its edge, from one point of the hairspring to the next.
  strip(coil, poses) {
    const { gl } = this, b = 3 * coil.body, base = coil.on < 0 ? 0 : poses[3 * coil.on + 2];
    const line = coil.line(poses[b + 2] - base - coil.rest, 300 / coil.outer), n = line.length / 2, high = Math.max(2.5 * coil.width, 0.015 * coil.outer), bottom = this.solids.top + 0.5 * high;
    const points = new Float32Array(6 * n), normals = new Float32Array(6 * n), faces = new Uint32Array(6 * (n - 1));
    for (let i = 0; i < n; i++) {
      const x = line[2 * i], y = line[2 * i + 1], r = Math.hypot(x, y);
      points.set([x, y, bottom, x, y, bottom + high], 6 * i); normals.set([x / r, y / r, 0, x / r, y / r, 0], 6 * i);
      if (i) faces.set([2 * i - 2, 2 * i - 1, 2 * i, 2 * i - 1, 2 * i + 1, 2 * i], 6 * (i - 1));
    }
    const kept = coil.shape ?? (coil.shape = this.shape(points, normals, gl.FLOAT, gl.FLOAT, faces));
    gl.bindVertexArray(kept.array);
    [points, normals].forEach((values, k) => { gl.bindBuffer(gl.ARRAY_BUFFER, kept.stores[k]); gl.bufferData(gl.ARRAY_BUFFER, values, gl.DYNAMIC_DRAW); });
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, faces, gl.DYNAMIC_DRAW);
    return { ...kept, body: coil.body, scale: 1, light: linear(coil.colours[0]), metal: 1, kind: gl.UNSIGNED_INT, count: faces.length, turned: base };
  }

  // Everything at the poses given; with `numbered` each body in a colour that says its number.
  draw(view, poses, look, numbered = false) {
    const { gl, at, canvas } = this, ratio = Math.max(view.ratio, FINE), width = Math.round(view.width * ratio), height = Math.round(view.height * ratio);
    if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; }
    const paper = numbered ? [0, 0, 0] : [1, 3, 5].map((k) => parseInt(look.paper.slice(k, k + 2), 16) / 255);
    gl.viewport(0, 0, width, height);
    gl.clearColor(...paper, 1); gl.depthMask(true); gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.BLEND); gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    // About the upright axis, then back from above; column by column.
    const c = Math.cos(view.turn + this.yaw), s = Math.sin(view.turn + this.yaw), ct = Math.cos(this.tilt), st = Math.sin(this.tilt);
    gl.uniformMatrix3fv(at.camera, false, [c, ct * s, -st * s, -s, ct * c, -st * c, 0, st, ct]);
    gl.uniform3f(at.sight, ...view.centre, view.scale);
    gl.uniform2f(at.half_size, 0.5 * view.width, 0.5 * view.height);
    gl.uniform1f(at.depth, 4 * Math.max(view.width, view.height) * Math.max(view.zoom, 1));
    const shown = [...this.pieces, ...this.coils.map((coil) => this.strip(coil, poses))], faded = (piece) => look.faded.has(piece.body);
    for (const piece of [...shown.filter((one) => !faded(one)), ...(numbered ? [] : shown.filter(faded))]) {
      const b = 3 * piece.body, angle = piece.turned ?? poses[b + 2], number = piece.body + 1;
      gl.depthMask(!faded(piece));
      gl.uniform4f(at.pose, poses[b], poses[b + 1], Math.cos(angle), Math.sin(angle));
      gl.uniform1f(at.scale, piece.scale); gl.uniform1f(at.metal, piece.metal); gl.uniform1f(at.alpha, faded(piece) ? FADED : 1);
      gl.uniform3fv(at.light, piece.light);
      gl.uniform3f(at.mark, ...(piece.body === look.chosen ? linear(look.accent) : [-1, -1, -1]));
      gl.uniform2f(at.number, ...(numbered ? [(number & 255) / 255, (number >> 8) / 255] : [0, 0]));
      gl.bindVertexArray(piece.array); gl.drawElements(gl.TRIANGLES, piece.count, piece.kind, 0);
    }
  }

  // The body at a place of the screen (CSS pixels), faded ones not; -1 where there is none.
  hit(view, poses, look, x, y) {
    const pixel = new Uint8Array(4);
    this.draw(view, poses, look, true);
    const { width, height } = this.canvas;
    this.gl.readPixels(Math.floor((x / view.width) * width), height - 1 - Math.floor((y / view.height) * height), 1, 1, this.gl.RGBA, this.gl.UNSIGNED_BYTE, pixel);
    return pixel[0] + 256 * pixel[1] - 1;
  }
}
