"use strict";
// Spheres by the graphics processor, for what moves: the library's kernels as functions for shaders, at a point per pixel.
// At rest the spheres are those of the library, whose pixels are means with errors.

const vertexText = `#version 300 es
void main() {
  vec2 corner = vec2(float((gl_VertexID << 1) & 2), float(gl_VertexID & 2));
  gl_Position = vec4(corner * 2.0 - 1.0, 0.0, 1.0);
}`;

const mostLights = 8;
const mostTextures = 16; // the grey sphere and six materials have two each
const mostAngles = 24; // the answers to "sky" have fewer

/** Lights and frame as in lib/src/render: x along the parallels about the vertical axis, y along the meridians. */
const sphereText = `
uniform int light_count;
uniform vec3 light_direction[${mostLights}];
uniform vec3 light_irradiance[${mostLights}];
uniform vec3 sky;
uniform highp sampler2D sky_values; // radiances under a sky of radiance 1 by azimuth and angle of the viewer
uniform int sky_angles;
uniform float sky_angle[${mostAngles}];
uniform float exposure;
uniform float size;
out vec4 shown;

vec3 to_local(vec3 d, vec3 normal, float reach) {
  float outwards = d.x * normal.x + d.z * normal.z;
  return vec3((d.x * normal.z - d.z * normal.x) / reach, reach * d.y - normal.y * outwards / reach,
              outwards + d.y * normal.y);
}

vec3 sky_radiance(vec3 view) {
  float angle = acos(min(view.z, 1.0)) * 57.29577951;
  float row = float(sky_angles - 1);
  for (int i = 1; i < sky_angles; ++i) {
    if (angle > sky_angle[i]) continue;
    row = float(i - 1) + (angle - sky_angle[i - 1]) / (sky_angle[i] - sky_angle[i - 1]);
    break;
  }
  vec2 size = vec2(textureSize(sky_values, 0));
  float turn = length(view.xy) > 0.0 ? atan(view.y, view.x) / 6.28318531 : 0.0;
  return texture(sky_values, vec2(turn + 0.5 / size.x, (row + 0.5) / size.y)).rgb;
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
  vec3 radiance = sky == vec3(0.0) ? vec3(0.0) : sky * sky_radiance(view);
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
    this.textures = new Map(); // by answer, the one that was used longest ago first
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
   * Binds the texture of an answer, which is made when it is first asked for.
   * @param kind gl.TEXTURE_2D or gl.TEXTURE_3D
   * @param fill gives the bound texture its content
   */
  bind(unit, kind, answer, fill) {
    const { gl } = this;
    const known = this.textures.get(answer);
    const texture = known ?? gl.createTexture();
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(kind, texture);
    this.textures.delete(answer);
    this.textures.set(answer, texture);
    if (known !== undefined) return;
    fill();
    for (const side of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T, gl.TEXTURE_WRAP_R]) {
      gl.texParameteri(kind, side, gl.CLAMP_TO_EDGE);
    }
    gl.texParameteri(kind, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    gl.texParameteri(kind, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
    if (this.textures.size <= mostTextures) return;
    const [oldest, old] = this.textures.entries().next().value;
    gl.deleteTexture(old);
    this.textures.delete(oldest);
  }

  /** Whether the driver takes a shader, and textures as large as its own. */
  takes(shader) {
    const { gl } = this;
    const isSmall = shader.size === undefined || Math.max(...shader.size) <= gl.getParameter(gl.MAX_3D_TEXTURE_SIZE);
    return isSmall && this.program(shader.text) !== null;
  }

  bindValues(shader) {
    const { gl } = this;
    this.bind(0, gl.TEXTURE_3D, shader, () => {
      gl.texImage3D(gl.TEXTURE_3D, 0, gl.RGBA16F, ...shader.size, 0, gl.RGBA, gl.HALF_FLOAT, shader.numbers);
    });
  }

  bindSky(sky) {
    const { gl } = this;
    this.bind(1, gl.TEXTURE_2D, sky, () => {
      const { angles, azimuths, colours } = sky;
      const texels = new Float32Array(4 * angles.length * azimuths);
      for (let i = 0; i < angles.length * azimuths; ++i) {
        for (let row = 0; row < 3; ++row) texels[4 * i + row] = colours[colours.length === 3 ? row : 0][i];
      }
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA16F, azimuths, angles.length, 0, gl.RGBA, gl.FLOAT, texels);
    });
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.REPEAT);
  }

  /**
   * Draws a sphere.
   * @param shader the answer to "shader", or to "texture" with its numbers
   * @param seen the answer to "sky"; not needed without one
   * @param lights as asked of the server
   * \return whether it did
   */
  draw(shader, seen, lights, exposure, size) {
    const made = this.program(shader.text);
    if (made === null) return false;
    if (shader.numbers !== undefined) this.bindValues(shader);
    if (seen !== undefined) this.bindSky(seen);
    const { gl } = this;
    if (this.canvas.width !== size) {
      this.canvas.width = size;
      this.canvas.height = size;
    }
    gl.viewport(0, 0, size, size);
    gl.useProgram(made.program);
    const points = lights.points ?? [];
    const flat = (lists) => new Float32Array(lists.flat());
    if (shader.numbers === undefined) {
      gl.uniform4fv(made.place("lobe_constants"), flat(shader.constants));
      gl.uniform3fv(made.place("lobe_weights"), flat(shader.weights));
    } else {
      gl.uniform1i(made.place("lobe_values"), 0);
    }
    gl.uniform1i(made.place("light_count"), points.length);
    if (points.length > 0) {
      const unit = (direction) => direction.map((one) => one / Math.hypot(...direction));
      gl.uniform3fv(made.place("light_direction"), flat(points.map((one) => unit(one.direction))));
      gl.uniform3fv(made.place("light_irradiance"), flat(points.map((one) => one.colour.map((part) => part * one.irradiance))));
    }
    const sky = lights.sky ?? { radiance: 0, colour: [0, 0, 0] };
    gl.uniform3fv(made.place("sky"), new Float32Array(sky.colour.map((part) => part * sky.radiance)));
    gl.uniform1i(made.place("sky_values"), 1);
    gl.uniform1i(made.place("sky_angles"), seen?.angles.length ?? 0);
    if (seen !== undefined) gl.uniform1fv(made.place("sky_angle"), new Float32Array(seen.angles));
    gl.uniform1f(made.place("exposure"), exposure);
    gl.uniform1f(made.place("size"), size);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    this.frames += 1;
    return true;
  }
}
