'use strict';
// The plots, drawn by Chart.js.

const charts = [];
const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue('--' + name).trim();

// Where the slider stands, in every plot over iterations.
const stepLine = {
  id: 'stepLine',
  afterDatasetsDraw(chart) {
    const k = chart.options.plugins.stepLine.k;
    if (k === null || k === undefined) return;
    const x = chart.scales.x.getPixelForValue(k);
    const {top, bottom} = chart.chartArea;
    chart.ctx.save();
    chart.ctx.strokeStyle = colour('soft');
    chart.ctx.beginPath();
    chart.ctx.moveTo(x, top);
    chart.ctx.lineTo(x, bottom);
    chart.ctx.stroke();
    chart.ctx.restore();
  },
};

function axis(title, options = {}) {
  return {
    title: {display: true, text: title, color: colour('soft')},
    ticks: {color: colour('soft'), maxTicksLimit: 8},
    grid: {color: colour('line')},
    ...options,
  };
}

function addChart(canvas, configuration) {
  configuration.options = {
    animation: false,
    maintainAspectRatio: false,
    interaction: {mode: 'nearest', axis: 'x', intersect: false},
    ...configuration.options,
  };
  configuration.options.plugins = {legend: {display: false}, ...configuration.options.plugins};
  charts.push(new Chart(canvas, configuration));
}

// series: {name, values, colour, side ('y' or 'right'), dash}
function addLinePlot(title, xs, series, axes, onPick) {
  const canvas = make('canvas');
  canvas.setAttribute('role', 'img');
  canvas.setAttribute('aria-label', title + ' over the iterations');
  byId('charts').append(make('div', [make('h3', title), make('div', canvas)], 'chart'));
  addChart(canvas, {
    type: 'line',
    plugins: [stepLine],
    data: {
      datasets: series.map((one) => ({
        label: one.name, data: xs.map((x, i) => ({x, y: one.values[i]})), yAxisID: one.side ?? 'y', borderWidth: 2,
        pointRadius: xs.length > 1 ? 0 : 3, pointHoverRadius: 4, borderDash: one.dash ? [5, 3] : [],
        themeColour: one.colour, borderColor: colour(one.colour), backgroundColor: colour(one.colour),
      })),
    },
    options: {
      onClick: (event, hits) => { if (hits.length > 0) onPick(hits[0].index); },
      plugins: {
        stepLine: {k: null},
        legend: {display: series.length > 1, labels: {color: colour('text'), boxWidth: 22, boxHeight: 1}},
      },
      scales: {
        x: axis('iteration k', {
          type: 'linear', min: xs[0], max: xs[xs.length - 1],
          ticks: {color: colour('soft'), precision: 0, includeBounds: false},
        }),
        ...axes,
      },
    },
  });
}

function showPlots(onPick) {
  const records = run.iterations;
  byId('loop').hidden = records.length === 0;
  if (records.length === 0) return;
  const ks = records.map((record) => record.k);
  const plot = (title, series, axes) => addLinePlot(title, ks, series, axes, onPick);
  const values = (key) => records.map((record) => record[key]);
  const right = (title, options) => axis(title, {position: 'right', grid: {drawOnChartArea: false}, ...options});
  plot('Weights', [{name: 'W_fd, feature distance', values: values('w_fd'), colour: 'source'},
    {name: 'W_ed, Euclidean distance', values: values('w_ed'), colour: 'target', dash: true}],
  {y: axis('weight', {min: 0, max: 1})});
  plot('Mismatch threshold T_cd', [{name: 'T_cd', values: values('t_cd'), colour: 'accent'}],
    {y: axis('compound distance [bits]', {beginAtZero: true})});
  plot('Matches', [{name: 'matches', values: values('matches'), colour: 'match'},
    {name: 'candidate pairs below T_cd', values: values('candidate_edges'), colour: 'target', dash: true}],
  {y: axis('number', {beginAtZero: true})});
  plot('Energy', [{name: 'energy', values: values('energy'), colour: 'accent'}],
    {y: axis('energy [bits]', {beginAtZero: true})});
  plot('Residuals', [{name: 'matched keypoints, RMS', values: records.map(keypointRms), colour: 'match'},
    {name: 'clouds where they overlap, median', values: iterationPoses().map((pose) => pose.median), colour: 'source',
      dash: true}],
  {y: axis('distance [units of the cloud]', {beginAtZero: true})});
  const turns = values('rotation_step_rad').map((step) => positive(degrees(step)));
  plot('Step sizes', [{name: 'rotation', values: turns, colour: 'source'},
    {name: 'translation', values: values('translation_step').map(positive), colour: 'target', dash: true,
      side: 'right'}],
  {y: axis('rotation [deg]', logarithmic()), right: right('translation [units]', logarithmic())});
}

// Powers of ten; 2 and 5 between them where there are few.
function logarithmic() {
  const callback = (value, index, ticks) => {
    const decades = Math.log10(ticks[ticks.length - 1].value / ticks[0].value);
    const digit = Number(value.toExponential(6).slice(0, 8));
    if (!(digit === 1 || (decades < 2 && (digit === 2 || digit === 5)))) return '';
    return value < 0.001 ? value.toExponential(0) : String(Number(value.toPrecision(1)));
  };
  return {type: 'logarithmic', ticks: {color: colour('soft'), callback}};
}

const positive = (value) => value > 0 ? value : null;  // a logarithmic axis has no place for 0

function keypointRms(record) {
  const pose = record.target_from_source;
  let sum = 0;
  for (const [s, t] of record.correspondences) {
    const p = run.source_keypoints[s], q = run.target_keypoints[t];
    for (let i = 0; i < 3; ++i) {
      sum += (pose[i][0] * p[0] + pose[i][1] * p[1] + pose[i][2] * p[2] + pose[i][3] - q[i]) ** 2;
    }
  }
  return record.correspondences.length > 0 ? Math.sqrt(sum / record.correspondences.length) : null;
}

const histogramBins = 50;

function showHistogram() {
  const canvas = byId('chart-histogram');
  addChart(canvas, {
    type: 'bar',
    data: {
      datasets: [{
        data: [], backgroundColor: colour('accent'), themeColour: 'accent', barPercentage: 1, categoryPercentage: 1,
      }],
    },
    options: {
      scales: {
        x: axis('distance to the nearest target point [units of the cloud]',
          {type: 'linear', min: 0, max: scene.reach, offset: false}),
        y: axis('source points', {beginAtZero: true}),
      },
    },
  });
}

// The distances of the drawn source points at a pose, those within reach.
function updateHistogram(pose) {
  const bins = new Array(histogramBins).fill(0);
  for (const step of pose.distances) {
    if (step < 255) ++bins[Math.min(histogramBins - 1, Math.floor(step / 255 * histogramBins))];
  }
  const chart = charts.find((one) => one.canvas.id === 'chart-histogram');
  chart.data.datasets[0].data = bins.map((y, i) => ({x: (i + 0.5) / histogramBins * scene.reach, y}));
  chart.update();
  const drawn = pose.distances.length;
  byId('histogram-note').textContent =
    `${pose.label}: ${count(pose.within)} of the ${count(drawn)} source points drawn ` +
    `(${percent(pose.within / drawn)}) have a target point within ${short(scene.reach)} units ` +
    `(${voxels(scene.reach_in_voxels)})` + (pose.within > 0 ? `; median ${short(pose.median)} units. ` : '. ') +
    'The distance between points has a floor that neither pose nor noise explains: the spacing of the target. ' +
    'The RMSE above is along the normals and has not.';
}

function recolourPlots() {
  for (const chart of charts) {
    for (const set of chart.data.datasets) set.borderColor = set.backgroundColor = colour(set.themeColour);
    for (const scale of Object.values(chart.options.scales)) {
      scale.title.color = scale.ticks.color = colour('soft');
      scale.grid.color = colour('line');
    }
    if (chart.options.plugins.legend.labels) chart.options.plugins.legend.labels.color = colour('text');
    chart.update();
  }
}

function movePlotLine(k) {
  for (const chart of charts) {
    if (!chart.options.plugins.stepLine) continue;
    chart.options.plugins.stepLine.k = k;
    chart.draw();
  }
}
