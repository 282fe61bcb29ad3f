// The model of the vehicle.
'use strict';

// An X of arms with rotors that reach to the body's radius [m], true to scale, x forward.
Goshawk.vehicleModel = function(radius, theme) {
  const model = new G3.Group(), r = radius, {body, accent} = theme;
  const part = (geometry, material, x, y, z) => {
    const mesh = new G3.Mesh(geometry, material);
    mesh.position.set(x, y, z);
    model.add(mesh);
    return mesh;
  };
  const shell = new G3.MeshLambertMaterial({color: body});
  const hull = part(new G3.SphereBufferGeometry(0.3 * r, 24, 16), shell, 0, 0, 0);
  hull.scale.set(1.35, 1, 0.55);
  const nose = part(new G3.ConeBufferGeometry(0.14 * r, 0.4 * r, 20),
                    new G3.MeshLambertMaterial({color: accent}), 0.52 * r, 0, 0);
  nose.rotation.z = -Math.PI / 2;
  for (const [x, y] of [[1, 1], [1, -1], [-1, 1], [-1, -1]]) {
    const d = 0.43 * r, color = x > 0 ? accent : body;
    const arm = part(new G3.BoxBufferGeometry(0.62 * r, 0.07 * r, 0.05 * r), shell,
                     x * d * 0.55, y * d * 0.55, 0);
    arm.rotation.z = Math.atan2(y, x);
    const disc = part(new G3.CylinderBufferGeometry(0.36 * r, 0.36 * r, 0.015 * r, 36),
                      new G3.MeshBasicMaterial({color, transparent: true, opacity: 0.4}),
                      x * d, y * d, 0.11 * r);
    disc.rotation.x = Math.PI / 2;
    part(new G3.TorusBufferGeometry(0.36 * r, 0.025 * r, 8, 40),
         new G3.MeshLambertMaterial({color}), x * d, y * d, 0.11 * r);
  }
  model.add(halo(3.4 * r, accent));
  return model;

  // A ring around the vehicle, drawn in front of everything.
  function halo(width, color) {
    const canvas = document.createElement('canvas');
    canvas.width = canvas.height = 64;
    const g = canvas.getContext('2d');
    g.strokeStyle = '#fff';
    g.lineWidth = 4;
    g.beginPath(); g.arc(32, 32, 28, 0, 7); g.stroke();
    const sprite = new G3.Sprite(new G3.SpriteMaterial({
      map: new G3.CanvasTexture(canvas), color, transparent: true, opacity: 0.85, depthTest: false}));
    sprite.scale.setScalar(width);
    sprite.renderOrder = 7;
    return sprite;
  }
};
