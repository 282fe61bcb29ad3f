// Messages as the pages' own shapes: boxes that move, predictions, clouds.
'use strict';

const kVector = v => [v.x, v.y, v.z], kTurn = q => [q.w, q.x, q.y, q.z];

// Of goshawk_msgs/MovingBox.
Goshawk.movingBox = m => ({id: m.id, kind: m.kind, p: kVector(m.pose.position), q: kTurn(m.pose.orientation),
                           half: kVector(m.half_extents)});

// Of goshawk_msgs/PredictedObstacle.
Goshawk.predictedBox = m => ({
  id: m.id, q: kTurn(m.orientation), half: kVector(m.half_extents), error: m.error, error_rate: m.error_rate,
  valid_until: m.valid_until,
  track: m.track.map(piece => ({duration: piece.duration, points: piece.control_points.map(kVector)}))});

// The places of a sensor_msgs/PointCloud2 with x, y, z as float32, as numbers in a row; null for another one.
// Returns that are not finite are left out. @param pose {p, q} of the cloud's frame, null: map; most: places that
// are kept, evenly
Goshawk.cloudPlaces = (m, pose, most = 60000) => {
  const fields = ['x', 'y', 'z'].map(name => m.fields.find(f => f.name === name));
  if (fields.some(f => !f || f.datatype !== 7) || m.point_step < 12) return null;
  const count = Math.min(m.width * m.height, Math.floor(m.data.length / m.point_step));
  const view = new DataView(m.data.buffer, m.data.byteOffset, m.data.byteLength);
  const step = Math.max(1, Math.ceil(count / most)), places = [];
  for (let k = 0; k < count; k += step) {
    let p = fields.map(f => view.getFloat32(k * m.point_step + f.offset, !m.is_bigendian));
    if (!p.every(Number.isFinite)) continue;
    if (pose) {
      const u = pose.q.slice(1), twice = V3.cross(u, p).map(c => 2 * c);
      p = V3.add(pose.p, V3.add(V3.add(p, twice, pose.q[0]), V3.cross(u, twice)));
    }
    places.push(...p);
  }
  return new Float32Array(places);
};
