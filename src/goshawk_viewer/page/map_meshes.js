// The meshes of a map: its voxels' faces, and the ground below with its grid.
'use strict';
const G3 = THREE;

const kVoxelVertex = `
attribute vec3 cell; attribute float face; attribute vec4 ao;
uniform vec3 origin; uniform float edge; uniform float inset;
varying vec2 q; varying vec4 open; varying vec3 normalMap; varying float height; varying float far;
void main() {
  float axis = floor(face / 2.0 + 0.01);
  float way = mod(face, 2.0) < 0.5 ? 1.0 : 0.0;
  vec3 n = axis < 0.5 ? vec3(1, 0, 0) : axis < 1.5 ? vec3(0, 1, 0) : vec3(0, 0, 1);
  vec3 u = n.zxy; vec3 v = n.yzx;
  vec3 p = origin + edge * (cell + n * way + u * position.x + v * position.y);
  q = position.xy; open = ao; normalMap = n * (2.0 * way - 1.0); height = p.z;
  vec4 eye = modelViewMatrix * vec4(p, 1.0);
  far = -eye.z;
  gl_Position = projectionMatrix * eye;
}`;

// Soft sky light, one sun, darker nooks, and thin voxel borders that vanish in the distance.
const kVoxelFragment = `
uniform vec3 low; uniform vec3 high; uniform vec3 sky; uniform float ink; uniform float opacity;
uniform vec2 span; uniform vec2 haze;
varying vec2 q; varying vec4 open; varying vec3 normalMap; varying float height; varying float far;
void main() {
  float rise = clamp((height - span.x) / max(span.y - span.x, 0.1), 0.0, 1.0);
  vec3 color = mix(low, high, rise);
  float light = 0.60 + 0.16 * normalMap.z + 0.26 * max(0.0, dot(normalMap, normalize(vec3(-0.5, -0.35, 0.8))))
              + 0.07 * normalMap.x;
  float nook = mix(mix(open.x, open.y, q.x), mix(open.z, open.w, q.x), q.y) / 3.0;
  light *= 0.55 + 0.45 * nook;
  vec2 width = fwidth(q);
  vec2 border = smoothstep(vec2(0.0), width * 1.2 + 0.015, min(q, 1.0 - q));
  float line = (1.0 - min(border.x, border.y)) * ink * clamp(1.0 - 2.2 * max(width.x, width.y), 0.0, 1.0);
  color *= light * (1.0 - 0.5 * line);
  color = mix(color, sky, 0.75 * smoothstep(haze.x, haze.y, far));
  gl_FragColor = vec4(color, opacity);
}`;

// Faces of voxels.
// @param faces of Goshawk.voxelFaces; style {low, high: colours by height up to top [m]; opacity, haze: [begin, end] [m], sky, ink}
// @return a mesh, or null if there are none
Goshawk.faceMesh = function(faces, voxels, style) {
  if (!faces.face.length) return null;
  const geometry = new G3.InstancedBufferGeometry();
  geometry.setAttribute('position', new G3.Float32BufferAttribute(
      [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0], 3));
  geometry.setIndex([0, 1, 2, 0, 2, 3]);
  geometry.setAttribute('cell', new G3.InstancedBufferAttribute(faces.cell, 3));
  geometry.setAttribute('face', new G3.InstancedBufferAttribute(faces.face, 1));
  geometry.setAttribute('ao', new G3.InstancedBufferAttribute(faces.ao, 4));
  geometry.maxInstancedCount = faces.face.length;
  const seeThrough = style.opacity < 1;
  const material = new G3.ShaderMaterial({
    uniforms: {
      origin: {value: new G3.Vector3(...voxels.origin)}, edge: {value: voxels.resolution},
      low: {value: new G3.Color(style.low)}, high: {value: new G3.Color(style.high)},
      sky: {value: new G3.Color(style.sky)}, ink: {value: style.ink},
      opacity: {value: style.opacity}, haze: {value: new G3.Vector2(...style.haze)},
      span: {value: new G3.Vector2(voxels.origin[2], Math.min(voxels.upper(2), style.top))},
    },
    vertexShader: kVoxelVertex, fragmentShader: kVoxelFragment, side: G3.DoubleSide,
    transparent: seeThrough, depthWrite: !seeThrough,
  });
  material.extensions.derivatives = true;
  const mesh = new G3.Mesh(geometry, material);
  mesh.frustumCulled = false;
  mesh.renderOrder = seeThrough ? 5 : 0;
  return mesh;
};

const kGroundFragment = `
uniform vec3 ground; uniform vec3 lines; uniform vec3 sky; uniform vec3 middle; uniform float radius;
varying vec3 at;
void main() {
  vec2 width = fwidth(at.xy);
  vec2 d = abs(fract(at.xy - 0.5) - 0.5) / width;
  float one = (1.0 - clamp(min(d.x, d.y), 0.0, 1.0)) * clamp(1.0 - 3.0 * max(width.x, width.y), 0.0, 1.0);
  vec2 d5 = abs(fract(at.xy / 5.0 - 0.5) - 0.5) / width * 5.0;
  float five = 1.0 - clamp(min(d5.x, d5.y), 0.0, 1.0);
  float fade = 1.0 - smoothstep(0.35, 1.0, distance(at, middle) / radius);
  vec3 color = mix(ground, lines, max(0.5 * one, 0.9 * five));
  gl_FragColor = vec4(mix(sky, color, fade), 1.0);
}`;

// A round floor of a radius [m] with lines each metre and stronger ones each five.
Goshawk.groundMesh = function(middle, radius, theme) {
  const material = new G3.ShaderMaterial({
    uniforms: {ground: {value: new G3.Color(theme.ground)}, radius: {value: radius},
               lines: {value: new G3.Color(theme.grid)}, middle: {value: middle},
               sky: {value: new G3.Color(theme.sky)}},
    vertexShader: `varying vec3 at;
      void main() { at = (modelMatrix * vec4(position, 1.0)).xyz;
                    gl_Position = projectionMatrix * viewMatrix * vec4(at, 1.0); }`,
    fragmentShader: kGroundFragment, side: G3.DoubleSide,
  });
  material.extensions.derivatives = true;
  const mesh = new G3.Mesh(new G3.CircleBufferGeometry(radius, 96), material);
  mesh.position.copy(middle);
  return mesh;
};
