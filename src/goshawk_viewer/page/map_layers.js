// The layers of the picture that show maps, in chunks: of a map that changes, few are made anew.
'use strict';
Goshawk.MapLayers = class {
  constructor(view) {
    this.view = view;
    this.sets = new Map();  // layer: {make: (z range, box) => faces, range, style, voxels, meshes}
  }

  static get names() { return ['obstacles', 'above', 'grown', 'unseen']; }

  // All of them, after the cut, the theme or what is shown changed.
  draw() {
    const {view} = this, {obstacles, grown, known, world} = view.maps, t = view.theme;
    for (const name of Goshawk.MapLayers.names) view.clear(name);
    this.sets.clear();
    if (!view.haze) {
      const radius = view.bounds().getBoundingSphere(new G3.Sphere()).radius;
      view.haze = [2.2 * radius, 6.5 * radius];
    }
    const top = voxels => voxels.layersBelow(view.cut);
    if (obstacles) this.add('obstacles', obstacles, 0, top(obstacles), [t.low, t.high], 1);
    const ghost = world || obstacles;  // of a map that grows, the true world; else what the cut removes
    if (ghost) {
      this.add('above', ghost, world ? 0 : top(ghost), world ? top(ghost) : ghost.size[2], [t.ghost, t.ghost],
               world ? 0.10 : 0.05);
    }
    if (grown) {
      const colors = obstacles ? [t.grown, t.grown] : [t.low, t.high];
      this.add('grown', grown, 0, top(grown), colors, obstacles ? 0.16 : 1);
    }
    if (known && obstacles) {
      this.add('unseen', known, 0, top(known), [t.unseen, t.unseen], 0.13,
               (z0, z1, box) => Goshawk.frontierFaces(known, obstacles, z0, z1, box));
    }
    view.redraw = true;
  }

  add(layer, voxels, z0, z1, [low, high], opacity, make) {
    const {view} = this, {sky, ink} = view.theme;
    if (!view.layers[layer].visible) return;  // made when shown
    const set = {voxels, meshes: new Map(), z0, z1,
                 make: make || ((a, b, box) => Goshawk.voxelFaces(voxels, a, b, box)),
                 style: {low, high, opacity, sky, ink, haze: view.haze, top: view.cut + 0.5}};
    this.sets.set(layer, set);
    for (const key of Goshawk.allChunks(voxels.size)) this.make(layer, set, key);
  }

  make(layer, set, key) {
    const group = this.view.layers[layer], old = set.meshes.get(key);
    if (old) {
      group.remove(old);
      old.geometry.dispose();
      old.material.dispose();
      set.meshes.delete(key);
    }
    const box = Goshawk.chunkBox(key, set.voxels.size);
    if (box[0].some((c, i) => c >= box[1][i]) || box[0][2] >= set.z1 || box[1][2] <= set.z0) return;
    const mesh = Goshawk.faceMesh(set.make(set.z0, set.z1, box), set.voxels, set.style);
    if (!mesh) return;
    set.meshes.set(key, mesh);
    group.add(mesh);
  }

  // The chunks of maps that changed; the true world does not. @param keys of Goshawk.chunkAt
  refresh(keys) {
    const {maps} = this.view;
    const changing = new Set([maps.obstacles, maps.grown, maps.known]);
    for (const [layer, set] of this.sets) {
      if (!changing.has(set.voxels)) continue;
      for (const key of keys) this.make(layer, set, key);
    }
    this.view.redraw = true;
  }
};
