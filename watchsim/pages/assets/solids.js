// The same mechanism in space, turned by hand and lit. Seen from above it lies exactly where the flat picture has it, in the
// colours of the palette: light that a surface sends straight back counts as 1.
const VERTEX = `#version 300 es
in vec3 point; in vec3 normal;
uniform vec4 pose; uniform vec3 sight; uniform mat3 camera; uniform vec2 half_size; uniform float scale; uniform float depth;
out vec3 facing; out vec3 watcher;
vec3 turned(vec3 v) { return vec3(pose.z * v.x - pose.w * v.y, pose.w * v.x + pose.z * v.y, v.z); }
void main() {
  vec3 seen = camera * (turned(scale * point) + vec3(pose.xy, 0.0) - vec3(sight.xy, 0.0)) * sight.z;
  facing = turned(normal);
  vec3 straight = vec3(0.0, 0.0, 1.0) * camera; // the way back to the eye; its level part is 0 from above, where light comes straight back
  watcher = straight - 0.35 * length(straight.xy) * (vec3(seen.xy / max(half_size.x, half_size.y), 0.0) * camera); // from an eye at some distance
  gl_Position = vec4(seen.xy / half_size, -seen.z / depth, 1.0);
}`;
const FRAGMENT = `#version 300 es
precision highp float;
in vec3 facing; in vec3 watcher; uniform vec3 light; uniform float metal; uniform float alpha; uniform vec3 mark; uniform vec2 number;
out vec4 colour;
// A studio: bright above, dim below, two windows and the dark edge of the table.
float studio(vec3 way) {
  float sky = mix(0.3, 1.0, smoothstep(-0.7, 0.55, way.z)) + 0.16 * (1.0 - way.z * way.z) * dot(way.xy, vec2(-0.6, 0.8)) - 0.22 * exp(-pow((way.z + 0.12) / 0.12, 2.0));
  return sky + 0.55 * smoothstep(0.82, 0.98, dot(way, normalize(vec3(-0.62, 0.55, 0.38)))) + 0.4 * smoothstep(0.88, 0.99, dot(way, normalize(vec3(0.8, -0.35, 0.1))));
}
void main() {
  if (number.x + number.y > 0.0) { colour = vec4(number, 0.0, 1.0); return; }
  vec3 n = normalize(facing), eye = normalize(watcher);
  if (dot(n, eye) < 0.0) n = -n;
  float past = 1.0 - dot(n, eye), twice = past * past, grazing = 0.8 * twice * twice * past, mirrored = studio(reflect(-eye, n));
  vec3 metallic = mix(light, vec3(1.0), grazing) * mirrored;
  float soft = mix(0.5, 1.0, smoothstep(-0.3, 0.75, n.z + 0.25 * dot(n.xy, vec2(-0.6, 0.8))));
  vec3 clear = light * soft + 0.5 * max(mirrored - 1.0, 0.0) + 0.4 * grazing;
  vec3 sent = mix(mix(clear, metallic, metal), mark, mark.x < 0.0 ? 0.0 : 0.5);
  sent /= max(1.0, max(sent.r, max(sent.g, sent.b))); // what is too bright for a screen keeps its hue
  // sRGB, IEC 61966-2-1; roots in place of its power, 2.4, within 0.01 of 255, for processors that draw without a graphics card.
  vec3 root = sqrt(max(sent, 1e-5)), fourth = sqrt(root), high = 0.65398581 * root + 0.68871364 * fourth - 0.3184755 * sqrt(fourth) - 0.02018856 * sent - 0.00406679;
  colour = vec4(clamp(mix(12.92 * sent, high, step(0.0031308, sent)), 0.0, 1.0), 1.0) * alpha;
}`;
const TILT = 0.85, STEEPEST_TILT = 1.5; // radians from above: at first, at most
// Pixels of the picture for one of the screen: at rest the first at least, with smoothed edges; moving, as many as the machine keeps up with.
const FINENESS = [2, 1.5, 1, 0.75, 0.5];
const SLOW = 1000 / 53, FAST = 1000 / 58, JUDGED = 12, PATIENCE = 90; // ms from frame to frame that are too many, and enough; frames of a judgement, and before a finer try
const SAMPLES = 4; // of a pixel at rest
const linear = (colour) => [1, 3, 5].map((k) => { const c = parseInt(colour.slice(k, k + 2), 16) / 255; return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4; });

// How finely a moving picture is drawn: coarser at once where frames come too slowly, finer when they have come in time for long;
// each finer try that fails makes the next one wait twice as long.
class Pace {
  constructor() { this.rung = 0; this.gaps = []; this.calm = 0; this.patience = PATIENCE; this.tried = false; }

  get ratio() { return FINENESS[this.rung]; }

  // A frame came so many ms after the one before, of which scripts took `own`: what they take no coarser picture gives back.
  frame(gap, own) {
    this.gaps.push(gap - own > 0.5 * gap ? gap : Math.min(gap, 0.99 * SLOW));
    if (this.gaps.length < JUDGED) return;
    // The mean without the longest: a screen shows every frame for a whole number of its periods, so that a median says nothing.
    const usual = (this.gaps.reduce((sum, one) => sum + one) - Math.max(...this.gaps)) / (JUDGED - 1);
    this.gaps = [];
    if (usual > SLOW && this.rung < FINENESS.length - 1) {
      if (this.tried) this.patience *= 2;
      this.rung++; this.calm = 0; this.tried = false;
    } else if (usual > FAST) this.calm = 0;
    else if ((this.calm += JUDGED) >= this.patience && this.rung > 0) { this.rung--; this.calm = 0; this.tried = true; }
  }
}

class Solids {
  constructor(data, canvas) {
    this.solids = data.solids; this.coils = data.coils.map((one) => new Coil(one));
    this.canvas = canvas; this.on = false; this.gl = null; this.pace = new Pace(); this.rises = new Map();
    this.level();
  }

  get any() { return Boolean(this.solids); }
  level() { this.tilt = TILT; this.yaw = 0.35; }
  orbit(dx, dy) { this.yaw += 0.01 * dx; this.tilt = clamp(this.tilt + 0.01 * dy, 0, STEEPEST_TILT); }

  // About the upright axis, then back from above; column by column.
  camera(view) {
    const c = Math.cos(view.turn + this.yaw), s = Math.sin(view.turn + this.yaw), ct = Math.cos(this.tilt), st = Math.sin(this.tilt);
    return [c, ct * s, -st * s, -s, ct * c, -st * c, 0, st, ct];
  }

  // Where names find places in space: on the upper face of their part.
  sight(view) {
    const m = this.camera(view), { width, height } = view, [x0, y0] = view.centre;
    return {
      width, height, corner: null, plain: (ctx) => view.plain(ctx),
      point: (poses, b, x, y) => [...view.point(poses, b, x, y), this.rise(b, x, y)],
      screen: (x, y, z = this.solids.top) => [0.5 * width + view.scale * (m[0] * (x - x0) + m[3] * (y - y0)), 0.5 * height - view.scale * (m[1] * (x - x0) + m[4] * (y - y0) + m[7] * z)],
    };
  }

  // The height of the highest triangle of body b over a point of its frame; beside its face that of the nearest corner.
  rise(b, x, y) {
    const key = `${b} ${x} ${y}`, known = this.rises.get(key);
    if (known !== undefined) return known;
    let over = -Infinity, near = Infinity, beside = 0;
    for (const { body, points, faces, scale } of this.pieces) {
      if (body !== b) continue;
      const px = (x / scale) * 32767, py = (y / scale) * 32767, side = (i, j) => (points[3 * j] - points[3 * i]) * (py - points[3 * i + 1]) - (points[3 * j + 1] - points[3 * i + 1]) * (px - points[3 * i]);
      for (let i = 0; i < points.length; i += 3) {
        const apart = Math.hypot(points[i] - px, points[i + 1] - py) * scale, high = (points[i + 2] * scale) / 32767;
        if (apart < near || (apart === near && high > beside)) { near = apart; beside = high; }
      }
      for (let k = 0; k < faces.length; k += 3) {
        const [i, j, l] = faces.subarray(k, k + 3), low = Math.min(points[3 * i + 2], points[3 * j + 2], points[3 * l + 2]);
        if (side(i, j) >= 0 && side(j, l) >= 0 && side(l, i) >= 0) over = Math.max(over, (low * scale) / 32767);
      }
    }
    this.rises.set(key, Number.isFinite(over) ? over : beside);
    return this.rises.get(key);
  }

  // Show or hide; false where the browser has no WebGL 2.
  turn(on) {
    if (on && !this.gl && !this.start()) return false;
    this.on = on; this.canvas.hidden = !on;
    return true;
  }

  start() {
    const gl = this.canvas.getContext("webgl2", { antialias: false, premultipliedAlpha: true });
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
      const faces = bytesOf(piece.faces), points = new Int16Array(bytesOf(piece.points).buffer), shape = this.shape(points, new Int8Array(bytesOf(piece.normals).buffer), gl.SHORT, gl.BYTE, faces);
      return { ...shape, points, faces: new (piece.wide ? Uint32Array : Uint16Array)(faces.buffer), body: piece.body, scale: piece.scale, top: piece.scale * points.reduce((top, at, k) => (k % 3 === 2 && at > top ? at : top), -32767), closed: true, light: linear(piece.fill), metal: piece.metal ? 1 : 0, kind: piece.wide ? gl.UNSIGNED_INT : gl.UNSIGNED_SHORT, count: faces.length / (piece.wide ? 4 : 2) };
    }).sort((one, other) => other.top - one.top); // what lies on top hides the rest before that is lit
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

  // Several samples for each pixel of the canvas; what is drawn into them goes there by `blitFramebuffer`.
  sample(width, height) {
    const { gl } = this, kept = this.samples ?? (this.samples = { frame: gl.createFramebuffer(), stores: [gl.createRenderbuffer(), gl.createRenderbuffer()] });
    gl.bindFramebuffer(gl.FRAMEBUFFER, kept.frame);
    if (kept.width === width && kept.height === height) return;
    Object.assign(kept, { width, height });
    [[gl.RGBA8, gl.COLOR_ATTACHMENT0], [gl.DEPTH_COMPONENT24, gl.DEPTH_ATTACHMENT]].forEach(([kind, role], k) => {
      gl.bindRenderbuffer(gl.RENDERBUFFER, kept.stores[k]);
      gl.renderbufferStorageMultisample(gl.RENDERBUFFER, SAMPLES, kind, width, height);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, role, gl.RENDERBUFFER, kept.stores[k]);
    });
  }

  // Everything at the poses given, as finely as the machine keeps up with where it is moving; with `numbered` each body in a colour that says its number.
  draw(view, poses, look, moving = false, numbered = false) {
    const { gl, at, canvas } = this, ratio = moving && this.pace.rung ? this.pace.ratio : Math.max(view.ratio, FINENESS[0]), width = Math.round(view.width * ratio), height = Math.round(view.height * ratio);
    if (canvas.width !== width || canvas.height !== height) { canvas.width = width; canvas.height = height; }
    if (moving || numbered) gl.bindFramebuffer(gl.FRAMEBUFFER, null); else this.sample(width, height);
    const paper = numbered ? [0, 0, 0] : [1, 3, 5].map((k) => parseInt(look.paper.slice(k, k + 2), 16) / 255);
    gl.viewport(0, 0, width, height);
    gl.clearColor(...paper, 1); gl.depthMask(true); gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    gl.uniformMatrix3fv(at.camera, false, this.camera(view));
    gl.uniform3f(at.sight, ...view.centre, view.scale);
    gl.uniform2f(at.half_size, 0.5 * view.width, 0.5 * view.height);
    gl.uniform1f(at.depth, 4 * Math.max(view.width, view.height) * Math.max(view.zoom, 1));
    const shown = [...this.pieces, ...this.coils.map((coil) => this.strip(coil, poses))], faded = (piece) => look.faded.has(piece.body);
    for (const piece of [...shown.filter((one) => !faded(one)), ...(numbered ? [] : shown.filter(faded))]) {
      const b = 3 * piece.body, angle = piece.turned ?? poses[b + 2], number = piece.body + 1;
      gl.depthMask(!faded(piece));
      for (const [what, on] of [[gl.BLEND, faded(piece)], [gl.CULL_FACE, piece.closed && !faded(piece)]]) if (on) gl.enable(what); else gl.disable(what);
      gl.uniform4f(at.pose, poses[b], poses[b + 1], Math.cos(angle), Math.sin(angle));
      gl.uniform1f(at.scale, piece.scale); gl.uniform1f(at.metal, piece.metal); gl.uniform1f(at.alpha, faded(piece) ? FADED : 1);
      gl.uniform3fv(at.light, piece.light);
      gl.uniform3f(at.mark, ...(piece.body === look.chosen ? linear(look.accent) : [-1, -1, -1]));
      gl.uniform2f(at.number, ...(numbered ? [(number & 255) / 255, (number >> 8) / 255] : [0, 0]));
      gl.bindVertexArray(piece.array); gl.drawElements(gl.TRIANGLES, piece.count, piece.kind, 0);
    }
    if (moving || numbered) return;
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, this.samples.frame); gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, null);
    gl.blitFramebuffer(0, 0, width, height, 0, 0, width, height, gl.COLOR_BUFFER_BIT, gl.NEAREST);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  // The body at a place of the screen (CSS pixels), faded ones not; -1 where there is none.
  hit(view, poses, look, x, y) {
    const pixel = new Uint8Array(4);
    this.draw(view, poses, look, false, true);
    const { width, height } = this.canvas;
    this.gl.readPixels(Math.floor((x / view.width) * width), height - 1 - Math.floor((y / view.height) * height), 1, 1, this.gl.RGBA, this.gl.UNSIGNED_BYTE, pixel);
    return pixel[0] + 256 * pixel[1] - 1;
  }
}
