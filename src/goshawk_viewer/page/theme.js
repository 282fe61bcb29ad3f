// The colours of a dark and a light picture, and of speeds.
'use strict';
Goshawk.themes = {
  dark: {sky: 0x0d1320, ground: 0x141c2d, grid: 0x3a4a68, low: 0x46536e, high: 0xa9b6cf, ink: 0.45,
         ghost: 0x8fa3c8, grown: 0x5b7cc0, raw: 0xc9a4ff, pruned: 0xff9f43, corridor: 0x39c5e8,
         flown: 0xffffff, body: 0xe9eef8, accent: 0xff4d5e, goal: 0x5df2a0},
  light: {sky: 0xf3f5f9, ground: 0xe7ebf2, grid: 0xb9c3d4, low: 0xaab5c8, high: 0xf4f6fa, ink: 0.5,
          ghost: 0x5f7196, grown: 0x4c6fb8, raw: 0x7c4dbc, pruned: 0xd96b00, corridor: 0x0a86b0,
          flown: 0x14181f, body: 0x20283a, accent: 0xd3122b, goal: 0x0b8a4b},
};
// Google's Turbo without its darkest ends: slow is blue, fast is red.
Goshawk.speedColor = function(ratio) {
  const stops = [[0.27, 0.42, 0.95], [0.13, 0.78, 0.87], [0.35, 0.95, 0.45], [0.95, 0.88, 0.25],
                 [0.98, 0.52, 0.16], [0.88, 0.16, 0.12]];
  const s = Math.max(0, Math.min(1, ratio)) * (stops.length - 1);
  const k = Math.min(stops.length - 2, Math.floor(s));
  return V3.mix(stops[k], stops[k + 1], s - k);
};
