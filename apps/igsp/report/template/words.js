'use strict';
// The run in words and tables. Numbers come from the data of the run, nothing is computed anew but residuals.

const data = JSON.parse(document.getElementById('data').textContent);
const run = data.run;
const scene = data.scene;

const byId = (id) => document.getElementById(id);
const percent = (share) => (100 * share).toFixed(share > 0 && share < 0.1 ? 1 : 0) + ' %';
const short = (value, digits = 3) => value === null ? 'not a number' : String(Number(value.toPrecision(digits)));
const count = (value) => value.toLocaleString('en');
const voxels = (value) => short(value) + ' voxels';
const degrees = (radians) => radians * 180 / Math.PI;

function make(tag, content, className) {
  const element = document.createElement(tag);
  if (className) element.className = className;
  for (const part of Array.isArray(content) ? content : [content ?? '']) element.append(part);
  return element;
}

function addRow(table, name, value, note) {
  const head = make('th', note ? [name, make('small', note)] : name);
  head.scope = 'row';
  table.append(make('tr', [head, make('td', value, 'value')]));
}

function addBar(bars, name, share, value) {
  const bar = make('i');
  bar.style.width = (100 * Math.min(1, Math.max(0, share))).toFixed(1) + '%';
  bars.append(make('span', name), make('div', bar), make('span', value));
}

// A confidence is never said to be certainty.
function confidenceText(confidence) {
  if (confidence > 0.999) return 'above 99.9 %';
  if (confidence < 0.001) return 'below 0.1 %';
  return (100 * confidence).toFixed(1) + ' %';
}

const endings = {
  converged: 'The loop converged',
  max_iterations: 'The loop ended at its limit of iterations',
  too_few_keypoints: 'Too few keypoints were found to begin with',
  too_few_matches: 'Fewer than three correspondences were left',
  degenerate_matches: 'The correspondences lie on a line',
};

function showVerdict() {
  const registered = run.verdict === 'registered';
  const name = (cloud) => cloud.path.split('/').pop();
  document.title = `${registered ? 'Registered' : 'Not registered'}: ${name(run.source)} onto ${name(run.target)}`;
  document.body.className = run.verdict;
  byId('verdict-word').textContent = registered ? '✓ Registered' : '✗ Not registered';
  byId('verdict-title').textContent = `${name(run.source)} onto ${name(run.target)}`;
  let text = `The source lies on the target, and the evidence says so: confidence ${confidenceText(run.confidence)}.`;
  if (!registered) {
    text = run.target_from_source
      ? 'No answer to rely on. The best estimate is shown below; ' +
        `the confidence in it is ${confidenceText(run.confidence)}.`
      : 'No transformation was found; the clouds are shown as they were given.';
  }
  byId('verdict-text').textContent = text;
  byId('warnings').hidden = run.warnings.length === 0;
  for (const warning of run.warnings) byId('warnings').append(make('li', 'Warning: ' + warning));
}

function addFreeSpace(table, freeSpace) {
  const parts = ['source', 'target'].filter((cloud) => freeSpace[cloud])
    .map((cloud) => `${(100 * freeSpace[cloud].share).toFixed(1)} % of the ${cloud}`);
  if (parts.length === 0) return;
  addRow(table, 'Seen through', parts.join(', '),
    'of what lies in the other scanner\'s view stands in front of what that scanner saw: at a right pose that space is empty');
}

function showEvidence() {
  const sentence = (text) => text.charAt(0).toUpperCase() + text.slice(1) + '.';
  byId('reason').textContent = sentence(run.reason);
  for (const cause of run.diagnosis) byId('diagnosis').append(make('li', sentence(cause.description)));
  byId('diagnosis').hidden = run.diagnosis.length === 0;
  const table = byId('evidence');
  const {mutual_matches: mutual, agreeing_matches: agreeing} = run.evidence;
  addRow(table, 'Confidence', confidenceText(run.confidence), 'that the pose is right; registered from 50 % on');
  if (run.target_from_source) {
    addRow(table, 'Matches that agree', `${count(agreeing)} of ${count(mutual)}`,
      'keypoints that choose each other by their descriptors, and those of them within ' +
      `${voxels(scene.reach_in_voxels)} at this pose`);
    addRow(table, 'Surfaces touch', percent(run.evidence.contact_share),
      'of the places where the surfaces come near each other');
    addFreeSpace(table, run.evidence.free_space);
    addRow(table, 'RMSE', short(run.rmse), 'units of the cloud; along the normals, where the surfaces meet');
    addRow(table, 'Quality', short(run.evidence.quality), 'both questions in one number, as log10 odds');
  }
  addRow(table, 'Runner-up', run.runner_up ? percent(run.runner_up.share) : 'none',
    run.runner_up ? 'of the matches of this pose agree at the best other one; near 100 % the two are hard to tell apart'
      : 'no other pose was worth looking into');
  const ending = endings[run.termination] ?? run.termination;
  addRow(table, 'Iterations', String(run.iterations.length), ending);
  addBar(byId('overlap'), 'of the source', run.overlap_source, percent(run.overlap_source));
  addBar(byId('overlap'), 'of the target', run.overlap_target, percent(run.overlap_target));
  byId('matrix').textContent = run.target_from_source ? matrixText(run.target_from_source) : 'none was found';
}

function matrixText(rows) {
  const texts = rows.map((row) => row.map(String));
  const width = (column) => Math.max(...texts.map((row) => row[column].length));
  return texts.map((row) => row.map((text, column) => text.padStart(width(column))).join('  ')).join('\n');
}

function showPrecision() {
  const place = byId('precision');
  const free = run.precision.free_directions;
  for (const direction of free) place.append(make('p', `Not fixed: ${direction.description}.`));
  const deviation = run.precision.covariance.map((row, i) => Math.sqrt(row[i]));
  if (deviation.every((value) => value === 0)) {
    place.append(make('p', 'Not determined: there was no fine registration, or too little for it.'));
    return;
  }
  const table = make('table');
  table.append(make('tr', ['standard deviation', 'x', 'y', 'z'].map((text) => make('th', text))));
  const row = (name, values) =>
    table.append(make('tr', [make('th', name), ...values.map((value) => make('td', short(value)))]));
  row('rotation about [deg]', deviation.slice(0, 3).map(degrees));
  row('translation along [units]', deviation.slice(3));
  const note = 'From the residuals of the fine registration, those of one patch of surface counted as one.';
  place.append(table, make('p', note, 'note'));
  if (free.length === 0) place.append(make('p', 'No direction is free at this pose.'));
}

function showRun() {
  const table = byId('clouds');
  table.append(make('tr', ['', 'source', 'target'].map((text) => make('th', text))));
  const both = (name, of) =>
    table.append(make('tr', [make('th', name), make('td', of(run.source)), make('td', of(run.target))]));
  both('file', (cloud) => cloud.path);
  both('points', (cloud) => count(cloud.points) + (cloud.streamed ? ', streamed' : ''));
  both('dropped, not finite', (cloud) => count(cloud.dropped_points));
  both('voxels', (cloud) => count(cloud.voxels));
  both('keypoints', (cloud) => count(cloud.keypoints));
  const shared = (name, value) => {
    addRow(table, name, value);
    table.lastChild.lastChild.colSpan = 2;
  };
  shared('voxel size', short(run.voxel_size, 6) + ' units');
  shared('peak memory', (run.peak_memory_bytes / 1048576).toFixed(0) + ' MiB');

  const seconds = Object.entries(run.timings_s);
  const longest = Math.max(...seconds.map(([, time]) => time));
  const total = seconds.reduce((sum, [, time]) => sum + time, 0);
  for (const [stage, time] of seconds) addBar(byId('timings'), stage, time / longest, time.toFixed(3) + ' s');
  byId('timings').append(make('b', 'together'), make('span'), make('b', total.toFixed(3) + ' s'));

  const options = byId('options');
  const entries = Object.entries(run.options);
  const plain = ([, value]) => typeof value !== 'object' || value === null;
  for (const [name, value] of entries.filter(plain)) addRow(options, name, String(value));
  for (const [section, values] of entries.filter((entry) => !plain(entry))) {
    const head = make('th', section);
    head.colSpan = 2;
    options.append(make('tr', head));
    for (const [name, value] of Object.entries(values)) addRow(options, name, String(value));
  }
  byId('made-by').textContent = `Made by igsp ${run.version}. This file is complete: it opens without a network.`;
}
