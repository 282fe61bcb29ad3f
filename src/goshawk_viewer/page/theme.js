// The colours of a dark and a light picture, and of speeds.
'use strict';
Goshawk.themes = {
  dark: {sky: 0x0d1320, ground: 0x141c2d, grid: 0x3a4a68, low: 0x46536e, high: 0xa9b6cf, ink: 0.45,
         ghost: 0x8fa3c8, grown: 0x5b7cc0, raw: 0xc9a4ff, pruned: 0xf2e24c, corridor: 0x39c5e8,
         flown: 0xffffff, body: 0xe9eef8, accent: 0xff4d5e, goal: 0x5df2a0, unseen: 0x7a6bd6,
         nominal: 0x9fd8ff, stop: 0xb6ff3c, mover: 0xff8ad8, cloud: 0xf2e24c},
  light: {sky: 0xf3f5f9, ground: 0xe7ebf2, grid: 0xb9c3d4, low: 0x9fabc1, high: 0xe6eaf2, ink: 0.5,
          ghost: 0x5f7196, grown: 0x4c6fb8, raw: 0x7c4dbc, pruned: 0x7d6b00, corridor: 0x0a86b0,
          flown: 0x14181f, body: 0x20283a, accent: 0xd3122b, goal: 0x0b8a4b, unseen: 0x6a55c9,
          nominal: 0x2f6fb0, stop: 0x4f7d00, mover: 0xb0127f, cloud: 0x8a6a00},
};
// Slow is blue, fast is orange: from bluer to yellower all the way, which every kind of colour
// vision tells apart, and far from white and black. Pictures and markers have the same colours.
Goshawk.speedColor = function(ratio) {
  const stops = [[0.18, 0.42, 1.0], [0.50, 0.34, 0.96], [0.82, 0.26, 0.70], [0.93, 0.28, 0.34],
                 [1.0, 0.52, 0.10]];
  const s = Math.max(0, Math.min(1, ratio)) * (stops.length - 1);
  const k = Math.min(stops.length - 2, Math.floor(s));
  return V3.mix(stops[k], stops[k + 1], s - k);
};
