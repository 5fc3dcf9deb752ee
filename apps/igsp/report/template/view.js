'use strict';
// The picture, drawn by three.js, whenever something changed. Coordinates are those of the target about its origin.

const vertexShader = `
  attribute vec3 normals;  // of either sign
  attribute float separation;
  attribute float contradicts;  // 1: in space that the other scanner saw through
  uniform float pointSize;
  uniform bool byDistance, markContradicting;
  uniform vec3 plain, far, contradicting, ramp[4];
  uniform float lift;  // towards the eye, along the ray: decides who hides whom, moves nothing on the screen
  uniform mat3 turn;
  varying vec3 shade;
  void main() {
    vec4 place = modelMatrix * vec4(position, 1.0);
    float s = separation * 255.0 / 254.0 * 3.0;
    vec3 graded = mix(ramp[0], ramp[1], clamp(s, 0.0, 1.0));
    graded = mix(graded, ramp[2], clamp(s - 1.0, 0.0, 1.0));
    graded = mix(graded, ramp[3], clamp(s - 2.0, 0.0, 1.0));
    shade = !byDistance ? plain : separation > 0.999 ? far : graded;
    bool marked = markContradicting && contradicts > 0.5;
    if (marked) shade = contradicting;
    vec3 eye = normalize(cameraPosition - place.xyz);
    shade *= mix(0.6, 1.08, abs(dot(normalize(turn * normals + 1e-6), eye)));
    gl_Position = projectionMatrix * viewMatrix * (place + vec4(lift * eye, 0.0));
    gl_PointSize = marked ? 1.5 * pointSize : pointSize;
  }`;
const fragmentShader = `
  varying vec3 shade;
  void main() { gl_FragColor = vec4(shade, 1.0); }`;

const looks = {oblique: [-0.6, -1, 0.75], top: [0, -0.0001, 1], front: [0, -1, 0.02], side: [1, 0, 0.02]};

class View {
  constructor(canvas) {
    this.draw = onceAFrame(() => this.drawNow());
    this.renderer = new THREE.WebGLRenderer({canvas, antialias: true, preserveDrawingBuffer: true});
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.renderer.setScissorTest(true);
    this.camera = new THREE.PerspectiveCamera(35, 1, 1, 10);
    this.world = new THREE.Scene();
    this.framed = true;  // until the reader turns the picture, it follows the clouds
    this.compare = false;
    this.source = this.addCloud(scene.source);
    this.target = this.addCloud(scene.target);
    this.target.matrix = this.unit(scene.target);
    this.matches = new THREE.Group();
    this.world.add(this.matches);
    this.pose = scene.poses[0];
    this.direction = looks.oblique;
    this.setUp([0, 0, 1]);
    new ResizeObserver(() => this.draw()).observe(canvas);
    canvas.addEventListener('keydown', (event) => this.turnByKey(event));
    this.recolour();
  }

  unit(cloud) {  // from 16 bits to local coordinates
    const scale = new THREE.Matrix4().makeScale(...cloud.extent.map((length) => length || 1));
    return new THREE.Matrix4().makeTranslation(...cloud.min).multiply(scale);
  }

  addCloud(cloud) {
    const geometry = new THREE.BufferGeometry();
    const coordinates = new Uint16Array(bytesOf(cloud.coordinates).buffer);
    cloud.values = coordinates;
    geometry.setAttribute('position', new THREE.BufferAttribute(coordinates, 3, true));
    geometry.setAttribute('normals', new THREE.BufferAttribute(new Int8Array(bytesOf(cloud.normals).buffer), 3, true));
    geometry.setAttribute('separation', new THREE.BufferAttribute(new Uint8Array(cloud.drawn).fill(255), 1, true));
    geometry.setAttribute('contradicts', this.none(cloud));
    const uniforms = {
      markContradicting: {value: false}, contradicting: {value: new THREE.Color()},
      pointSize: {value: 2}, byDistance: {value: false}, lift: {value: 0}, turn: {value: new THREE.Matrix3()},
      plain: {value: new THREE.Color()}, far: {value: new THREE.Color()},
      ramp: {value: rampColours.map((one) => new THREE.Color(one))},
    };
    const points = new THREE.Points(geometry, new THREE.ShaderMaterial({vertexShader, fragmentShader, uniforms}));
    points.matrixAutoUpdate = false;
    points.frustumCulled = false;
    this.world.add(points);
    return points;
  }

  none(cloud) {
    return new THREE.BufferAttribute(new Uint8Array(cloud.drawn), 1);
  }

  setPose(pose) {
    this.pose = pose;
    if (this.framed) this.frame();
    this.draw();
  }

  // Places the source and its matches for one pane.
  place(pose) {
    const matrix = new THREE.Matrix4().set(...pose.matrix.flat());
    this.source.material.uniforms.turn.value.setFromMatrix4(matrix);
    this.source.matrix = matrix.multiply(this.unit(scene.source));
    this.source.geometry.setAttribute('separation', pose.separation);
    for (const name of ['source', 'target']) {
      if (pose.contradicts[name]) this[name].geometry.setAttribute('contradicts', pose.contradicts[name]);
    }
    this.matches.remove(...this.matches.children);
    this.matches.add(...this.matchObjects(pose));
  }

  matchObjects(pose) {
    if (pose.objects) return pose.objects;
    const places = [], colours = [];
    const match = new THREE.Color(colour('match')), apart = new THREE.Color(colour('apart'));
    for (const [s, t, agrees] of pose.pairs) {
      const p = transformed(pose.matrix, minus(run.source_keypoints[s], scene.source.origin));
      places.push(...p, ...minus(run.target_keypoints[t], scene.target.origin));
      const shade = agrees ? match : apart;
      for (let end = 0; end < 2; ++end) colours.push(shade.r, shade.g, shade.b);
    }
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute('position', new THREE.BufferAttribute(new Float32Array(places), 3));
    geometry.setAttribute('color', new THREE.BufferAttribute(new Float32Array(colours), 3));
    const shared = {vertexColors: THREE.VertexColors, transparent: true};
    const lines = new THREE.LineBasicMaterial({...shared, opacity: 0.75});
    const ends = new THREE.PointsMaterial({...shared, size: 5, sizeAttenuation: false, opacity: 0.95});
    pose.objects = [new THREE.LineSegments(geometry, lines), new THREE.Points(geometry, ends)];
    for (const object of pose.objects) object.frustumCulled = false;
    return pose.objects;
  }

  // Some of the points that a pose shows.
  sample(pose) {
    const points = [];
    const add = (cloud, matrix) => {
      const stride = 3 * Math.ceil(cloud.drawn / 3000);
      for (let i = 0; i < cloud.values.length; i += stride) {
        points.push(new THREE.Vector3().fromArray(cloud.values, i).divideScalar(65535).applyMatrix4(matrix));
      }
    };
    add(scene.target, this.unit(scene.target));
    add(scene.source, new THREE.Matrix4().set(...pose.matrix.flat()).multiply(this.unit(scene.source)));
    return points;
  }

  // Where to look and from how far, so that nearly all points are in the pane; a few stray ones must not make the rest
  // a dot. The middle of the points is not the middle of their picture, since what is near is large: hence the passes.
  fit(pose, back) {
    const points = this.sample(pose);
    const right = new THREE.Vector3().crossVectors(this.camera.up, back).normalize();
    const up = new THREE.Vector3().crossVectors(back, right);
    const vertical = Math.tan(this.camera.fov * Math.PI / 360), horizontal = vertical * this.aspect();
    const rank = (values, share) => values.sort((a, b) => a - b)[Math.round(share * (values.length - 1))];
    const middle = (values) => (rank(values, 0.02) + rank(values, 0.98)) / 2;
    const centre = new THREE.Vector3(...['x', 'y', 'z'].map((axis) => middle(points.map((point) => point[axis]))));
    let distance = 0;
    for (let pass = 0; pass < 4; ++pass) {
      const offsets = points.map((point) => point.clone().sub(centre));
      distance = Math.max(1e-9, 1.12 * rank(offsets.map((offset) => offset.dot(back) +
        Math.max(Math.abs(offset.dot(right)) / horizontal, Math.abs(offset.dot(up)) / vertical)), 0.98));
      const seen = offsets.filter((offset) => offset.dot(back) < 0.9 * distance);
      for (const side of [right, up]) {
        const shift = middle(seen.map((offset) => offset.dot(side) / (distance - offset.dot(back))));
        if (pass < 3) centre.addScaledVector(side, shift * distance);
      }
    }
    return {centre, distance};
  }

  frame() {
    const turn = new THREE.Quaternion().setFromUnitVectors(new THREE.Vector3(0, 0, 1), this.camera.up);
    const back = new THREE.Vector3(...this.direction).normalize().applyQuaternion(turn);
    this.frames = this.panes().map((pose) => this.fit(pose, back));
    const {centre, distance} = this.frames[this.frames.length - 1];
    this.controls.target.copy(centre);
    this.camera.position.copy(centre).addScaledVector(back, distance);
    this.controls.update();
  }

  // The controls move the camera of the last pane; that of the other one does the same about a centre of its own.
  cameraOf(pane) {
    const last = this.frames[this.frames.length - 1], own = this.frames[pane];
    const scale = own.distance / last.distance;
    const offset = this.camera.position.clone().sub(this.controls.target).multiplyScalar(scale);
    const target = this.controls.target.clone().sub(last.centre).multiplyScalar(scale).add(own.centre);
    const camera = this.camera.clone();
    camera.position.copy(target).add(offset);
    camera.lookAt(target);
    Object.assign(camera, {aspect: this.aspect(), near: offset.length() / 100, far: offset.length() * 100});
    camera.updateProjectionMatrix();
    return camera;
  }

  // OrbitControls takes the axis that it turns about when it is made.
  setUp(axis) {
    this.camera.up.set(...axis);
    if (this.controls) this.controls.dispose();
    this.controls = new THREE.OrbitControls(this.camera, this.renderer.domElement);
    this.controls.enableKeys = false;  // it would take the arrow keys of the whole page
    this.controls.addEventListener('start', () => { this.framed = false; });
    this.controls.addEventListener('change', () => this.draw());
    this.look(this.direction);
  }

  // From a direction in which z is up.
  look(direction) {
    this.direction = direction;
    this.framed = true;
    this.frame();
    this.draw();
  }

  turnByKey(event) {
    const turns = {
      ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1], '+': 0.85, '=': 0.85, '-': 1 / 0.85,
    };
    const turn = turns[event.key];
    if (turn === undefined) return;
    event.preventDefault();
    this.framed = false;
    const offset = this.camera.position.clone().sub(this.controls.target);
    if (typeof turn === 'number') {
      offset.multiplyScalar(turn);
    } else {
      const angle = Math.PI / 24;
      const polar = offset.angleTo(this.camera.up) - turn[1] * angle;
      const side = new THREE.Vector3().crossVectors(this.camera.up, offset).normalize();
      if (polar > 0.02 && polar < Math.PI - 0.02) offset.applyAxisAngle(side, -turn[1] * angle);
      offset.applyAxisAngle(this.camera.up, turn[0] * angle);
    }
    this.camera.position.copy(this.controls.target).add(offset);
    this.controls.update();
    this.draw();
  }

  recolour() {
    this.renderer.setClearColor(colour('stage'));
    this.source.material.uniforms.plain.value.set(colour('source'));
    this.target.material.uniforms.plain.value.set(colour('target'));
    for (const cloud of [this.source, this.target]) {
      cloud.material.uniforms.far.value.set(colour('far'));
      cloud.material.uniforms.contradicting.value.set(colour('empty'));
    }
    for (const pose of scene.poses) pose.objects = null;
    this.draw();
  }

  colourByDistance(on) {
    this.source.material.uniforms.byDistance.value = on;
    this.source.material.uniforms.lift.value = on ? scene.reach / 5 : 0;  // its colours before the grey of the target
    this.target.material.uniforms.byDistance.value = on;  // it has no distances: all of it grey
    this.draw();
  }

  markContradicting(on) {
    for (const cloud of [this.source, this.target]) cloud.material.uniforms.markContradicting.value = on;
    this.draw();
  }

  setPointSize(size) {
    const pixels = size * this.renderer.getPixelRatio();
    for (const cloud of [this.source, this.target]) cloud.material.uniforms.pointSize.value = pixels;
    this.draw();
  }

  panes() {
    return this.compare ? [scene.poses[0], this.pose] : [this.pose];
  }

  aspect() {
    const canvas = this.renderer.domElement;
    return Math.max(canvas.clientWidth, 1) / (this.compare ? 2 : 1) / Math.max(canvas.clientHeight, 1);
  }

  drawNow() {
    const {clientWidth: width, clientHeight: height} = this.renderer.domElement;
    if (width === 0) return;
    this.renderer.setSize(width, height, false);
    const panes = this.panes();
    panes.forEach((pose, i) => {
      this.place(pose);
      const pane = [i * width / panes.length, 0, width / panes.length, height];
      this.renderer.setViewport(...pane);
      this.renderer.setScissor(...pane);
      this.renderer.render(this.world, this.cameraOf(i));
    });
  }
}
