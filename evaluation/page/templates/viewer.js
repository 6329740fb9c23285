"use strict";

// Draws the scene (scene.py) in a figure made by viewer.html. Left button or finger: turn;
// wheel or two fingers: zoom; right button: move.
function showScene(figure) {
  const scene = JSON.parse(figure.querySelector("script").textContent);
  const caption = figure.querySelector("figcaption");
  const place = figure.querySelector(".canvas");
  let renderer;
  try {
    renderer = new THREE.WebGLRenderer({antialias: true, preserveDrawingBuffer: true});
  } catch (error) {
    caption.textContent = "This browser cannot draw points: it has no WebGL.";
    return;
  }
  renderer.setPixelRatio(window.devicePixelRatio);
  place.appendChild(renderer.domElement);

  const world = new THREE.Scene();
  world.background = new THREE.Color(0x30343a);
  const lens = new THREE.PerspectiveCamera(50, 1, scene.typical / 1000, scene.typical * 1000);
  lens.up.copy(upwards(scene.cameras));
  const controls = new THREE.OrbitControls(lens, renderer.domElement);
  controls.screenSpacePanning = true;
  const draw = () => renderer.render(world, lens);
  controls.addEventListener("change", draw);

  const cameras = new THREE.Group();
  cameras.add(frusta(scene.cameras.filter(camera => camera.used), 0xff9a3c));
  cameras.add(frusta(scene.cameras.filter(camera => !camera.used), 0x9aa0a8));
  world.add(cameras);
  let points = null;

  // As the photograph saw it; from farther back, more around it is seen.
  function lookFrom(camera, back) {
    const [centre, ...corners] = vectors(camera);
    const ahead = average(corners).sub(centre).normalize();
    controls.target.copy(centre).addScaledVector(ahead, camera.distance);
    lens.position.copy(centre).addScaledVector(ahead, -back * camera.distance);
    controls.update();
    draw();
  }

  function showCloud(number) {
    const cloud = scene.clouds[number];
    if (points) {
      world.remove(points);
      points.geometry.dispose();
    }
    points = cloudOfPoints(cloud);
    world.add(points);
    caption.textContent = cloud.count < cloud.total
      ? `${cloud.count.toLocaleString("en")} of ${cloud.total.toLocaleString("en")} points, ` +
        "spread evenly; the file has all. "
      : `${cloud.total.toLocaleString("en")} points. `;
    caption.textContent += "Drag to turn, scroll to zoom, drag with the right button to move.";
    for (const label of figure.querySelectorAll(".confidence")) label.hidden = !cloud.levels;
    update();
  }

  const confidence = figure.querySelector(".confidence input");
  function update() {
    if (points) {
      const cloud = scene.clouds[points.userData.number];
      // Half as large again as the gaps; three.js takes sizes for those of a lens of 90 degrees.
      points.material.size = 1.5 * cloud.spacing * 2 ** figure.querySelector(".size").value /
        Math.tan(lens.fov * Math.PI / 360);
      const least = cloud.levels ? Number(confidence.value) : 0;
      figure.querySelector("output").value = (least / 255 * cloud.most).toFixed(1);
      // Levels fall along the points.
      points.geometry.setDrawRange(0, points.userData.levels
        ? points.userData.levels.filter(level => level >= least).length : cloud.count);
      const tint = cloud.levels && figure.querySelector(".tint").checked;
      points.geometry.setAttribute("color", tint ? points.userData.tints : points.userData.colors);
    }
    cameras.visible = figure.querySelector(".cameras").checked;
    draw();
  }

  function cloudOfPoints(cloud) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(
      new Float32Array(bytes(cloud.positions).buffer), 3));
    const made = new THREE.Points(geometry, new THREE.PointsMaterial(
      {vertexColors: THREE.VertexColors, sizeAttenuation: true}));
    made.userData.number = scene.clouds.indexOf(cloud);
    made.userData.colors = new THREE.BufferAttribute(bytes(cloud.colors), 3, true);
    if (cloud.levels) {
      made.userData.levels = bytes(cloud.levels);
      const tints = new Uint8Array(3 * cloud.count);
      made.userData.levels.forEach((level, i) => tints.set(scene.viridis[level], 3 * i));
      made.userData.tints = new THREE.BufferAttribute(tints, 3, true);
    }
    return made;
  }

  function fit() {
    const width = place.clientWidth, height = place.clientHeight;
    renderer.setSize(width, height, false);
    lens.aspect = width / height;
    lens.updateProjectionMatrix();
    draw();
  }

  const choice = figure.querySelector(".cloud select");
  scene.clouds.forEach((cloud, i) => choice.add(new Option(cloud.name, i)));
  choice.parentElement.hidden = scene.clouds.length < 2;
  choice.addEventListener("change", () => showCloud(choice.value));
  for (const input of figure.querySelectorAll("input")) input.addEventListener("input", update);
  for (const button of document.querySelectorAll("button[data-view]")) {
    button.addEventListener("click", () => {
      const camera = scene.cameras.find(entry => entry.name === button.dataset.view);
      lookFrom(camera, 0);
      figure.scrollIntoView();
    });
  }
  new ResizeObserver(fit).observe(place);
  fit();
  if (scene.clouds.length) showCloud(0);
  else caption.textContent = "There are no points; these are the cameras.";
  if (scene.cameras.length) lookFrom(scene.cameras[Math.floor(scene.cameras.length / 2)], 0.25);
  figure.dataset.drawn = "yes";
}

function bytes(text) {
  return Uint8Array.from(atob(text), letter => letter.charCodeAt(0));
}

// The centre of a camera and the four corners of its picture, from the top left clockwise.
function vectors(camera) {
  return [0, 3, 6, 9, 12].map(i => new THREE.Vector3().fromArray(camera.corners, i));
}

function average(list) {
  return list.reduce((sum, vector) => sum.add(vector), new THREE.Vector3())
    .divideScalar(Math.max(list.length, 1));
}

// Photographs are mostly taken upright.
function upwards(cameras) {
  const up = average(cameras.map(camera => {
    const [, topLeft, , , bottomLeft] = vectors(camera);
    return topLeft.sub(bottomLeft).normalize();
  }));
  return up.length() > 0.1 ? up.normalize() : new THREE.Vector3(0, 1, 0);
}

function frusta(cameras, color) {
  const ends = [];
  for (const camera of cameras) {
    const [centre, ...corners] = vectors(camera);
    corners.forEach((corner, i) => ends.push(centre, corner, corner, corners[(i + 1) % 4]));
  }
  return new THREE.LineSegments(new THREE.BufferGeometry().setFromPoints(ends),
                                new THREE.LineBasicMaterial({color}));
}
