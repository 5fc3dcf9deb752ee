'use strict';
// What the page of a pair and that of a network both need to draw.

const upAxes = {z: [0, 0, 1], y: [0, 1, 0], '-y': [0, -1, 0]};
const rampColours = ['#2b6cb0', '#2a9d8f', '#e9a23b', '#c8372d'];  // near to far

function bytesOf(text) {
  const letters = atob(text);
  const bytes = new Uint8Array(letters.length);
  for (let i = 0; i < letters.length; ++i) bytes[i] = letters.charCodeAt(i);
  return bytes;
}

function transformed(rows, p) {
  return rows.slice(0, 3).map((row) => row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3]);
}

const minus = (p, origin) => p.map((value, i) => value - origin[i]);

// Draws soon, and once for all that changed until then.
function onceAFrame(draw) {
  let isWaiting = false;
  return () => {
    if (isWaiting) return;
    isWaiting = true;
    requestAnimationFrame(() => {
      isWaiting = false;
      draw();
    });
  };
}
