// How surfaces, dots and lines are drawn: programs so small that they compile in no time, also
// where a processor stands in for the graphics card.

import {
  Color,
  DoubleSide,
  FrontSide,
  GLSL3,
  RawShaderMaterial,
  Vector2,
  Vector4,
} from "./three.js";

const HEAD = "precision highp float; uniform mat4 modelViewMatrix, projectionMatrix;";

/** From light to the numbers of a screen (sRGB). */
const SHOWN = `
precision highp float;
uniform vec3 colour;
uniform float opacity;
out vec4 pixel;
vec4 shown(vec3 light) {
  vec3 low = light * 12.92;
  vec3 high = 1.055 * pow(max(light, 0.0), vec3(1.0 / 2.4)) - 0.055;
  return vec4(mix(high, low, vec3(lessThan(light, vec3(0.0031308)))), opacity);
}`;

function material(options, vertexShader, fragmentShader, more = {}) {
  const uniforms = {
    colour: { value: new Color() },
    opacity: { value: options.opacity ?? 1 },
    ...Object.fromEntries(Object.entries(more).map(([name, value]) => [name, { value }])),
  };
  const made = new RawShaderMaterial({
    ...options,
    glslVersion: GLSL3,
    uniforms,
    vertexShader: HEAD + vertexShader,
    fragmentShader: SHOWN + fragmentShader,
  });
  made.paint = (colour) => uniforms.colour.value.set(colour);
  return made;
}

/** A surface under a lamp that goes with the eye; both of its sides are seen. */
export function solid({ behindLines = false, colour = "#888" } = {}) {
  const offset = { polygonOffset: behindLines, polygonOffsetFactor: 1, polygonOffsetUnits: 1 };
  const made = material(
    { side: DoubleSide, ...offset },
    `
    uniform mat3 normalMatrix;
    in vec3 position, normal;
    out vec3 seen, straight;
    void main() {
      vec4 place = modelViewMatrix * vec4(position, 1.0);
      seen = -place.xyz;
      straight = normalMatrix * normal;
      gl_Position = projectionMatrix * place;
    }`,
    `
    uniform float glow;
    uniform bool isOrthographic;
    in vec3 seen, straight;
    const vec3 LAMP = normalize(vec3(-0.35, 0.7, 1.0));
    void main() {
      vec3 n = normalize(straight);
      if (dot(n, isOrthographic ? vec3(0.0, 0.0, 1.0) : seen) < 0.0) n = -n;
      float light = 0.5 + 0.14 * n.y + 0.5 * max(dot(n, LAMP), 0.0);
      pixel = shown(colour * light + glow);
    }`,
    { glow: 0 },
  );
  made.paint(colour);
  return made;
}

/** Round dots of a size in pixels. */
export function dots(colour, opacity) {
  const made = material(
    { transparent: true, depthWrite: false, opacity },
    `
    uniform float size;
    in vec3 position;
    void main() {
      gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
      gl_PointSize = size;
    }`,
    `
    void main() {
      if (length(gl_PointCoord - 0.5) > 0.5) discard;
      pixel = shown(colour);
    }`,
    { size: 4 },
  );
  made.paint(colour);
  return made;
}

/** Lines of a width in pixels, each an instance of a strip from `start` to `end`. */
export function wide(width, options = {}) {
  return material(
    // always blended, so that faint lines need no program of their own
    { side: DoubleSide, ...options, transparent: true },
    `
    uniform vec2 picture;
    uniform float width, ratio;
    in vec3 position, start, end;
    const float NEAR = 1e-3;
    void main() {
      vec4 a = projectionMatrix * modelViewMatrix * vec4(start, 1.0);
      vec4 b = projectionMatrix * modelViewMatrix * vec4(end, 1.0);
      if (a.w < NEAR && b.w > NEAR) a = mix(a, b, (NEAR - a.w) / (b.w - a.w));
      if (b.w < NEAR && a.w > NEAR) b = mix(b, a, (NEAR - b.w) / (a.w - b.w));
      vec2 along = (b.xy / b.w - a.xy / a.w) * picture;
      along = length(along) > 0.0 ? normalize(along) : vec2(1.0, 0.0);
      vec2 away = position.x * vec2(-along.y, along.x) + (2.0 * position.y - 1.0) * along;
      gl_Position = position.y < 0.5 ? a : b;
      gl_Position.xy += away * width * ratio / picture * gl_Position.w;
    }`,
    "void main() { pixel = shown(colour); }",
    { width, ratio: 1, picture: new Vector2(1, 1) },
  );
}

/** A flat picture that faces the eye, its corners so many pixels from the point it marks. */
export function mark(map, box) {
  return material(
    { transparent: true, depthTest: false, depthWrite: false },
    `
    uniform vec2 picture;
    uniform vec4 box;
    uniform float ratio;
    in vec3 position;
    out vec2 spot;
    void main() {
      spot = position.xy;
      gl_Position = projectionMatrix * modelViewMatrix * vec4(0.0, 0.0, 0.0, 1.0);
      vec2 away = floor(mix(box.xy, box.zw, spot) * ratio + 0.5);
      gl_Position.xy += 2.0 * away / picture * gl_Position.w;
    }`,
    `
    uniform sampler2D map;
    in vec2 spot;
    void main() { pixel = texture(map, spot); }`,
    { map, box: new Vector4(...box), ratio: 1, picture: new Vector2(1, 1) },
  );
}

const viewport = new Vector4();

/** Tell a material that draws in pixels how many the picture has: a mesh's onBeforeRender. */
export function inPixels(renderer, _scene, _camera, _geometry, material) {
  renderer.getCurrentViewport(viewport);
  material.uniforms.picture.value.set(viewport.z, viewport.w);
  material.uniforms.ratio.value = renderer.getPixelRatio();
  material.uniformsNeedUpdate = true;
}

/** Lines as thin as a screen draws them. */
export function thin() {
  return material(
    { side: FrontSide },
    `
    in vec3 position;
    void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }`,
    "void main() { pixel = shown(colour); }",
  );
}
