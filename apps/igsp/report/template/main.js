'use strict';
// Brings picture, plots and words together: the slider walks over the steps of the run.

const agreeDistance = scene.reach;

function preparePoses() {
  const records = run.iterations;
  const finalPose = run.target_from_source;
  const pairsOf = (record) => record === undefined ? [] : record.correspondences.map(([s, t]) => {
    const pose = finalPose ?? record.target_from_source;
    const p = transformed(pose, run.source_keypoints[s]);
    return [s, t, Math.hypot(...minus(p, run.target_keypoints[t])) <= agreeDistance];
  });
  let iteration = 0;
  for (const pose of scene.poses) {
    pose.distances = bytesOf(pose.distances);
    const sorted = pose.distances.filter((step) => step < 255).sort();
    pose.within = sorted.length;
    pose.median = sorted.length > 0 ? sorted[sorted.length >> 1] / 254 * scene.reach : null;
    pose.record = pose.kind === 'iteration' ? records[iteration++] : records[records.length - 1];
    pose.pairs = pose.kind === 'runner_up' ? [] : pairsOf(pose.record);
    pose.label = {
      given: 'As given', iteration: `Iteration ${pose.k}`, final: 'Final pose', runner_up: 'Runner-up',
    }[pose.kind];
  }
}

const iterationPoses = () => scene.poses.filter((pose) => pose.kind === 'iteration');

function stepText(pose) {
  const near = `${percent(pose.within / pose.distances.length)} of the source within ${short(scene.reach)} units ` +
    'of the target';
  const agreeing = pose.pairs.filter((pair) => pair[2]).length;
  const where = run.target_from_source ? 'at the final pose' : 'here';
  const lines = pose.pairs.length === 0 ? '' : `${count(pose.pairs.length)} matched keypoints, ` +
    `${count(agreeing)} of them (green) within ${voxels(scene.reach_in_voxels)} of each other ${where}`;
  const record = pose.record;
  const details = {
    given: () => `the clouds in the frames of their files${lines ? '; lines: the ' + lines : ''}.`,
    iteration: () => `${lines}. Energy ${short(record.energy, 5)} bits, T_cd ${short(record.t_cd)} bits, ` +
      `W_fd ${record.w_fd.toFixed(2)}, W_ed ${record.w_ed.toFixed(2)}. ${near}.`,
    final: () => 'the answer, after the fine registration' +
      `${lines ? '; lines: the ' + lines + ', of the last iteration' : ''}. ${near}.`,
    runner_up: () => `the best other pose that was looked into. ${near}.`,
  };
  const nearer = pose.drawn_nearer === null ? ''
    : ` Drawn beside the target: its true place is ${short(pose.drawn_nearer)} units away.`;
  return `${pose.label}: ${details[pose.kind]()}${nearer}`;
}

function thinningText() {
  const part = (name) => {
    const {drawn} = scene[name], all = run[name].points;
    const kind = run[name].streamed ? 'centroids of small voxels instead of the' : 'of';
    return `${drawn < all ? `${count(drawn)} ${kind}` : 'all'} ${count(all)} points of the ${name}`;
  };
  const thinned = ['source', 'target'].some((name) => scene[name].drawn < run[name].points);
  return `Drawn: ${part('source')} and ${part('target')}${thinned ? ', thinned for display' : ''}. ` +
    `Distances are from each drawn source point to the nearest of ${count(scene.target.known)} target points. ` +
    'Drag to turn, wheel to zoom, right button to move; or Tab to the picture and use the arrow keys, plus and minus.';
}

function start() {
  preparePoses();
  showVerdict();
  showEvidence();
  showPrecision();
  showRun();
  showHistogram();
  const steps = scene.poses.filter((pose) => pose.kind !== 'runner_up');
  const runnerUp = scene.poses.find((pose) => pose.kind === 'runner_up');
  const slider = byId('step');
  slider.max = steps.length - 1;
  slider.value = steps.length - 1;
  slider.disabled = byId('play').disabled = steps.length === 1;
  if (steps.length === 1) byId('compare').checked = false;

  let view = null;
  try {
    view = new View(byId('picture'));
    for (const pose of scene.poses) {
      pose.separation = new THREE.BufferAttribute(pose.distances, 1, true);
      pose.contradicts = {};
      for (const name of ['source', 'target']) {
        const bytes = pose.contradicting[name];
        pose.contradicts[name] = bytes && new THREE.BufferAttribute(bytesOf(bytes), 1);
      }
    }
  } catch (error) {
    byId('no-picture').hidden = false;
  }

  const show = (pose) => {
    byId('runner-up').setAttribute('aria-pressed', String(pose === runnerUp));
    byId('step-text').textContent = stepText(pose);
    byId('pose-label').textContent = pose.label;
    slider.setAttribute('aria-valuetext', pose.label);
    if (view) view.setPose(pose);
    movePlotLine(pose.kind === 'iteration' ? pose.k : null);
    updateHistogram(pose);
  };
  const goTo = (index) => {
    slider.value = index;
    show(steps[index]);
  };
  showPlots((iteration) => goTo(iteration + 1));
  slider.addEventListener('input', () => show(steps[slider.valueAsNumber]));

  let timer = null;
  const stop = () => {
    clearInterval(timer);
    timer = null;
    byId('play').textContent = 'Play';
    byId('play').setAttribute('aria-pressed', 'false');
  };
  byId('play').addEventListener('click', () => {
    if (timer) return stop();
    let index = slider.valueAsNumber < steps.length - 1 ? slider.valueAsNumber : -1;
    byId('play').textContent = 'Stop';
    byId('play').setAttribute('aria-pressed', 'true');
    timer = setInterval(() => {
      goTo(++index);
      if (index === steps.length - 1) stop();
    }, 500);
  });
  slider.addEventListener('pointerdown', stop);

  if (runnerUp) {
    byId('runner-up').hidden = false;
    byId('runner-up').addEventListener('click', (event) => {
      const shown = event.target.getAttribute('aria-pressed') === 'true';
      show(shown ? steps[slider.valueAsNumber] : runnerUp);
    });
  }
  byId('picture-note').textContent = thinningText();
  if (view) connectTools(view);
  goTo(steps.length - 1);
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => {
    recolourPlots();
    if (view) view.recolour();
  });
}

function connectTools(view) {
  const toggle = (id, action) => {
    const box = byId(id);
    box.addEventListener('change', () => action(box.checked));
    action(box.checked);
  };
  toggle('show-source', (on) => { view.source.visible = on; view.draw(); });
  toggle('show-target', (on) => { view.target.visible = on; view.draw(); });
  toggle('show-matches', (on) => { view.matches.visible = on; view.draw(); });
  toggle('by-distance', (on) => { byId('scale').hidden = !on; view.colourByDistance(on); });
  const known = Object.values(scene.poses[0].contradicting).some((bytes) => bytes);
  byId('contradicting-group').hidden = !known;
  toggle('show-contradicting', (on) => view.markContradicting(on && known));
  toggle('compare', (on) => {
    byId('before-label').hidden = !on;
    byId('stage').classList.toggle('comparing', on);
    view.compare = on;
    view.look(view.direction);
  });
  byId('point-size').addEventListener('input', (event) => view.setPointSize(event.target.valueAsNumber));
  view.setPointSize(byId('point-size').valueAsNumber);
  byId('scale').querySelector('i').style.background = `linear-gradient(to right, ${rampColours.join(',')})`;
  byId('scale-near').textContent = '0';
  byId('scale-far').textContent = short(scene.reach) + ' units';
  byId('up').addEventListener('change', (event) => view.setUp(upAxes[event.target.value]));
  for (const button of document.querySelectorAll('[data-look]')) {
    button.addEventListener('click', () => view.look(looks[button.dataset.look]));
  }
}

start();
