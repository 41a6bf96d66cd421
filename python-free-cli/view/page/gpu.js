"use strict";
// Spheres by the graphics processor, for what moves: the library's kernels as functions for shaders, at a point per pixel.
// At rest the spheres are those of the library, whose pixels are means with errors.

const vertexText = `#version 300 es
void main() {
  vec2 corner = vec2(float((gl_VertexID << 1) & 2), float(gl_VertexID & 2));
  gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}`;

const mostLights = 8;
const albedoNodes = 21; // as the answers to "albedos" have

/** Lights and frame as in lib/src/render: x along the parallels about the vertical axis, y along the meridians. */
const sphereText = `
uniform int light_count;
uniform vec3 light_direction[${mostLights}];
uniform vec3 light_irradiance[${mostLights}];
uniform vec3 sky;
uniform vec3 albedo[${albedoNodes}];
uniform float albedo_angle[${albedoNodes}];
uniform float exposure;
uniform float size;
out vec4 shown;

vec3 to_local(vec3 d, vec3 normal, float reach) {
  float outwards = d.x * normal.x + d.z * normal.z;
  return vec3((d.x * normal.z - d.z * normal.x) / reach, reach * d.y - normal.y * outwards / reach,
              outwards + d.y * normal.y);
}

vec3 sky_albedo(float cosine) {
  float angle = acos(min(cosine, 1.0)) * 57.29577951;
  for (int i = 1; i < ${albedoNodes}; ++i) {
    if (angle > albedo_angle[i]) continue;
    return mix(albedo[i - 1], albedo[i], (angle - albedo_angle[i - 1]) / (albedo_angle[i] - albedo_angle[i - 1]));
  }
  return albedo[${albedoNodes - 1}];
}

float encoded(float linear) {
  float x = clamp(linear, 0.0, 1.0);
  return x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1.0 / 2.4) - 0.055;
}

void main() {
  vec2 place = gl_FragCoord.xy / size * 2.0 - 1.0;
  float radius = length(place);
  float cover = clamp((1.0 - radius) * 0.5 * size + 0.5, 0.0, 1.0);
  float background = 0.03189603; // of the level 50 of 255
  if (cover == 0.0) {
    shown = vec4(vec3(encoded(background)), 1.0);
    return;
  }
  place *= min(1.0, (1.0 - 0.5 / size) / max(radius, 1e-6));
  vec3 normal = vec3(place, sqrt(1.0 - dot(place, place)));
  float reach = sqrt(1.0 - place.y * place.y);
  vec3 view = to_local(vec3(0.0, 0.0, 1.0), normal, reach);
  vec3 radiance = sky == vec3(0.0) ? vec3(0.0) : sky * sky_albedo(view.z);
  for (int i = 0; i < light_count; ++i) {
    vec3 light = to_local(light_direction[i], normal, reach);
    if (light.z > 0.0) radiance += lobe_brdf(light, view) * light_irradiance[i] * light.z;
  }
  vec3 linear = mix(vec3(background), radiance * exposure, cover);
  shown = vec4(encoded(linear.r), encoded(linear.g), encoded(linear.b), 1.0);
}`;

/** null without WebGL 2. */
class Gpu {
  static make() {
    const canvas = document.createElement("canvas");
    const gl = canvas.getContext("webgl2", { antialias: false, preserveDrawingBuffer: true });
    return gl === null ? null : new Gpu(canvas, gl);
  }

  constructor(canvas, gl) {
    this.canvas = canvas;
    this.gl = gl;
    this.programs = new Map();
    this.frames = 0;
  }

  /** The program of a function for shaders; null where the driver does not take it. */
  program(text) {
    const known = this.programs.get(text);
    if (known !== undefined) return known;
    const { gl } = this;
    const program = gl.createProgram();
    const fragmentText = `#version 300 es\nprecision highp float;\n${text}${sphereText}`;
    for (const [kind, source] of [[gl.VERTEX_SHADER, vertexText], [gl.FRAGMENT_SHADER, fragmentText]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
      gl.deleteShader(shader);
    }
    gl.linkProgram(program);
    let made = null;
    if (gl.getProgramParameter(program, gl.LINK_STATUS)) {
      const place = (name) => gl.getUniformLocation(program, name);
      made = { program, place };
    }
    if (this.programs.size > 50) this.programs.clear();
    this.programs.set(text, made);
    return made;
  }

  /**
   * Draws a sphere.
   * @param shader the answer to "shader"
   * @param albedos colours and angles of the answer to "albedos"
   * @param lights as asked of the server
   * \return whether it did
   */
  draw(shader, albedos, lights, exposure, size) {
    const made = this.program(shader.text);
    if (made === null) return false;
    const { gl } = this;
    if (this.canvas.width !== size) {
      this.canvas.width = size;
      this.canvas.height = size;
    }
    gl.viewport(0, 0, size, size);
    gl.useProgram(made.program);
    const points = lights.points ?? [];
    const flat = (lists) => new Float32Array(lists.flat());
    gl.uniform4fv(made.place("lobe_constants"), flat(shader.constants));
    gl.uniform3fv(made.place("lobe_weights"), flat(shader.weights));
    gl.uniform1i(made.place("light_count"), points.length);
    if (points.length > 0) {
      const unit = (direction) => direction.map((one) => one / Math.hypot(...direction));
      gl.uniform3fv(made.place("light_direction"), flat(points.map((one) => unit(one.direction))));
      gl.uniform3fv(made.place("light_irradiance"), flat(points.map((one) => one.colour.map((part) => part * one.irradiance))));
    }
    const sky = lights.sky ?? { radiance: 0, colour: [0, 0, 0] };
    gl.uniform3fv(made.place("sky"), new Float32Array(sky.colour.map((part) => part * sky.radiance)));
    const colour = (i) => [0, 1, 2].map((row) => albedos.colours[albedos.colours.length === 3 ? row : 0][i]);
    gl.uniform3fv(made.place("albedo"), flat(albedos.angles.map((angle, i) => colour(i))));
    gl.uniform1fv(made.place("albedo_angle"), new Float32Array(albedos.angles));
    gl.uniform1f(made.place("exposure"), exposure);
    gl.uniform1f(made.place("size"), size);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    this.frames += 1;
    return true;
  }
}
