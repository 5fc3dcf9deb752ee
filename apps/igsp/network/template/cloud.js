'use strict';
// The points of a frame in a canvas: what is nearest to the eye gives a pixel its colour, how many points fall on it
// its opacity, so that walls show through ceilings.

const stationColour = (i, lightness) => `hsl(${Math.round(i * 137.508) % 360} 55% ${lightness}%)`;
const isDark = () => matchMedia('(prefers-color-scheme: dark)').matches;
const themeColour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name);

// Red, green and blue of a row of `width` pixels, as a canvas fills it.
function filledRow(width, styleOf) {
  const context = Object.assign(document.createElement('canvas'), {width, height: 1}).getContext('2d');
  for (let x = 0; x < width; ++x) {
    context.fillStyle = styleOf(context, x);
    context.fillRect(x, 0, 1, 1);
  }
  return context.getImageData(0, 0, width, 1).data;
}

function stationPalette() {
  const lightness = isDark() ? 62 : 48;
  return filledRow(network.scans.length, (context, i) => stationColour(i, lightness));
}

// By the bytes of the distances.
function distancePalette() {
  return filledRow(256, (context, step) => {
    if (step === 255) return themeColour('--far');
    const gradient = context.createLinearGradient(0, 0, 255, 0);
    rampColours.forEach((colour, k) => gradient.addColorStop(k / (rampColours.length - 1), colour));
    return gradient;
  });
}

const opacities = Uint8Array.from({length: 8}, (_, points) => Math.round(255 * (1 - 0.42 ** points)));

// Of every pixel the nearest point so far, as in a depth buffer, and how many there were.
function rasterOf(frame, {axes, scale, centre}, ratio, width, height, shown) {
  const nearest = new Int32Array(width * height).fill(-1), depth = new Float32Array(width * height);
  const number = new Uint8Array(width * height), side = Math.max(1, Math.round(1.6 * ratio));
  const [right, up, back] = axes.map((axis) => axis.map((x) => x * scale * ratio)), {points} = frame;
  const left = centre[0] * ratio - side / 2, top = centre[1] * ratio - side / 2;
  for (let p = 0, i = 0; p < frame.drawn; ++p, i += 3) {
    if (shown && !shown.has(frame.owner[p])) continue;
    const a = points[i], b = points[i + 1], c = points[i + 2];
    const x = Math.round(left + right[0] * a + right[1] * b + right[2] * c);
    const y = Math.round(top - up[0] * a - up[1] * b - up[2] * c);
    if (x < 0 || y < 0 || x + side > width || y + side > height) continue;
    const towards = back[0] * a + back[1] * b + back[2] * c;
    for (let row = 0; row < side; ++row) {
      for (let pixel = (y + row) * width + x, end = pixel + side; pixel < end; ++pixel) {
        if (number[pixel] < 7) ++number[pixel];
        if (nearest[pixel] >= 0 && depth[pixel] >= towards) continue;
        nearest[pixel] = p;
        depth[pixel] = towards;
      }
    }
  }
  return {nearest, number};
}

// `shown`: the scans whose points are drawn, null for all.
function drawCloud(canvas, frame, projection, byDistance, shown) {
  const ratio = window.devicePixelRatio || 1;
  const width = canvas.width = Math.round(canvas.clientWidth * ratio);
  const height = canvas.height = Math.round(canvas.clientHeight * ratio);
  const context = canvas.getContext('2d'), image = context.createImageData(width, height), {data} = image;
  const palette = byDistance ? distancePalette() : stationPalette(), index = byDistance ? frame.distance : frame.owner;
  const {nearest, number} = rasterOf(frame, projection, ratio, width, height, shown);
  nearest.forEach((p, pixel) => {
    if (p < 0) return;
    const from = 4 * index[p], to = 4 * pixel;
    data[to] = palette[from];
    data[to + 1] = palette[from + 1];
    data[to + 2] = palette[from + 2];
    data[to + 3] = opacities[number[pixel]];
  });
  context.putImageData(image, 0, 0);
}
