// SPDX-License-Identifier: MPL-2.0
// The picture in three dimensions. The frame of the drawing: the beam travels towards +z, y is up. Each tracker is a group that places its own frame, below the
// one before: their true distance is not known here and would leave no room. One that the beam crosses towards its -z is turned by 180 degrees about y.
import {
  BufferGeometry, CanvasTexture, CircleGeometry, Color, DoubleSide, EdgesGeometry, Float32BufferAttribute, Group, Line, LineBasicMaterial, LineDashedMaterial,
  LineSegments, Mesh, MeshBasicMaterial, OrthographicCamera, PerspectiveCamera, Points, PointsMaterial, Raycaster, Scene, Vector2, Vector3, WebGLRenderer,
} from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { Line2 } from "three/addons/lines/Line2.js";
import { LineGeometry } from "three/addons/lines/LineGeometry.js";
import { LineMaterial } from "three/addons/lines/LineMaterial.js";
import { CSS2DObject, CSS2DRenderer } from "three/addons/renderers/CSS2DRenderer.js";

import { colour } from "./theme.js";

export const trackColours = 5;
export const planeColours = 4;
const pixelsOfTrack = 3;
const ticksEvery = 200;  // mm
const rowHeight = 2.95;  // from one tracker to the next, in radii

/// Turns what is drawn of an event or a detector off the graphics card.
function dispose(group) {
  group.traverse((o) => {
    o.geometry?.dispose();
    o.material?.map?.dispose();
    o.material?.dispose();
    if (o.isCSS2DObject) o.element.remove();
  });
  group.clear();
}

/// The first and the last station in z, mm.
function ends(t) {
  const zs = t.stations.map((s) => s.position[2]);
  return { low: Math.min(...zs), high: Math.max(...zs) };
}

function disc(filled) {
  const size = 64;
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = size;
  const g = canvas.getContext("2d");
  g.beginPath();
  g.arc(size / 2, size / 2, size * 0.38, 0, 2 * Math.PI);
  g.lineWidth = size * 0.16;
  g.strokeStyle = g.fillStyle = "white";
  if (filled) g.fill();
  g.stroke();
  return new CanvasTexture(canvas);
}

function label(text, kind, at, parent) {
  const element = document.createElement("div");
  element.className = `label ${kind}`;
  element.textContent = text;
  const o = new CSS2DObject(element);
  o.position.set(...at);
  parent.add(o);
  return o;
}

export class EventScene {
  constructor(holder, detector, { picked, hovered }) {
    this.holder = holder;
    this.detector = detector;
    this.picked = picked;
    this.hovered = hovered;
    this.renderer = new WebGLRenderer({ antialias: true, preserveDrawingBuffer: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.labels = new CSS2DRenderer();
    Object.assign(this.labels.domElement.style, { position: "absolute", inset: "0", pointerEvents: "none" });
    holder.append(this.renderer.domElement, this.labels.domElement);

    this.scene = new Scene();
    this.perspective = new PerspectiveCamera(28, 1, 10, 40000);
    this.flat = new OrthographicCamera(-1, 1, 1, -1, 10, 40000);  // for the views along an axis
    this.camera = this.perspective;
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener("change", () => this.render());
    this.world = new Group();
    this.scene.add(this.world);
    this.shown = new Set(["stations", "space points", "tracks", "truth", "channels-0", "channels-1", "channels-2", "channels-3"]);
    this.tracker = null;  // all of them
    this.trackLines = [];
    this.chosen = null;
    this.groups = new Map();
    let below = 0;
    for (const t of detector) {
      const frame = new Group();
      frame.rotation.y = t.beam_direction > 0 ? 0 : Math.PI;
      const { low, high } = ends(t);
      frame.position.z = t.beam_direction > 0 ? -low : high;
      const [fixed, captions, event] = [new Group(), new Group(), new Group()];
      frame.add(fixed, captions, event);
      this.world.add(frame);
      this.groups.set(t.tracker, { frame, fixed, captions, event, below, turned: t.beam_direction < 0 });
      below -= rowHeight * t.active_radius;
    }
    this.drawDetector();
    this.listen();
    new ResizeObserver(() => this.resize()).observe(holder);
    this.resize();
    this.look("oblique");
  }

  /// Bounds of what is to be seen, mm.
  extent() {
    let length = 0, radius = 0, top = -Infinity, bottom = Infinity;
    for (const t of this.detector) {
      if (this.tracker !== null && t.tracker !== this.tracker) continue;
      const y = this.groups.get(t.tracker).below;
      const { low, high } = ends(t);
      length = Math.max(length, high - low);
      radius = Math.max(radius, t.active_radius);
      top = Math.max(top, y + 1.5 * t.active_radius);
      bottom = Math.min(bottom, y - 1.45 * t.active_radius);
    }
    return { length, radius, top: top * this.world.scale.y, bottom: bottom * this.world.scale.y };
  }

  look(view) {
    const { length, radius, top, bottom } = this.extent();
    const direction = {
      oblique: new Vector3(-0.86, 0.2, -0.45), side: new Vector3(-1, 0, 0), top: new Vector3(0, 1, 0), front: new Vector3(0, 0, 1),
    }[view].normalize();
    const fromAbove = view === "top", alongBeam = view === "front";
    const row = 3 * radius * this.world.scale.y;
    const wide = alongBeam ? top - bottom : 1.42 * length;
    const tall = alongBeam ? row : top - bottom;
    this.halfHeight = Math.max(tall, wide / this.perspective.aspect) / 2;
    this.camera = view === "oblique" ? this.perspective : this.flat;
    const tangent = Math.tan((this.perspective.fov * Math.PI) / 360);
    const away = view === "oblique" ? this.halfHeight / tangent + 0.4 * radius : 4 * (length + radius);
    this.controls.object = this.camera;
    const middle = (top + bottom) / 2;
    this.controls.target.set(fromAbove ? middle : alongBeam ? -middle : 0, fromAbove || alongBeam ? 0 : middle, length / 2 - 30);
    this.camera.up.set(fromAbove ? 1 : 0, fromAbove ? 0 : 1, 0);
    this.camera.position.copy(this.controls.target).addScaledVector(direction, away);
    this.camera.zoom = 1;
    this.frame();
    this.controls.update();
    // From above the trackers would hide each other: there they lie side by side, and their captions beside them. Along the beam there is room to the right.
    for (const { frame, captions, below, turned } of this.groups.values()) {
      frame.position.x = fromAbove ? below : alongBeam ? -below : 0;
      frame.position.y = fromAbove || alongBeam ? 0 : below;
      captions.rotation.z = fromAbove ? (turned ? Math.PI / 2 : -Math.PI / 2) : 0;
    }
    this.hidden = { front: "z", top: "scale" }[view] ?? null;
    this.applyLayers();
    this.render();
  }

  /// Adapts the cameras to the shape of the window.
  frame() {
    const { aspect } = this.perspective;
    const h = this.halfHeight ?? 1;
    Object.assign(this.flat, { left: -h * aspect, right: h * aspect, top: h, bottom: -h });
    this.flat.updateProjectionMatrix();
    this.perspective.updateProjectionMatrix();
  }

  stretch(factor) {
    this.world.scale.set(factor, factor, 1);
    this.render();
  }

  showTracker(tracker) {
    this.tracker = tracker;
    for (const [id, g] of this.groups) g.frame.visible = tracker === null || id === tracker;
    this.look("oblique");
  }

  drawDetector() {
    this.scene.background = new Color(colour("ground"));
    const ink = new Color(colour("station"));
    for (const t of this.detector) {
      const { fixed, captions } = this.groups.get(t.tracker);
      dispose(fixed);
      dispose(captions);
      const rim = 72;
      for (const s of t.stations) {
        const z = s.position[2] + s.planes.reduce((sum, p) => sum + p.z, 0) / Math.max(1, s.planes.length);
        const circle = new CircleGeometry(t.active_radius, rim);
        const sheet = new Mesh(circle, new MeshBasicMaterial({ color: ink, transparent: true, opacity: 0.07, side: DoubleSide, depthWrite: false }));
        const edge = new LineSegments(new EdgesGeometry(circle), new LineBasicMaterial({ color: ink, transparent: true, opacity: 0.75 }));
        for (const o of [sheet, edge]) {
          o.position.set(s.position[0], s.position[1], z);
          o.userData.layer = "stations";
          fixed.add(o);
        }
        label(`${s.station}`, "station", [0, t.active_radius * 1.1, z], captions).userData.layer = "z";
      }
      this.drawAxes(t, captions, ink);
    }
    this.applyLayers();
  }

  /// z in the frame of the tracker, below it, with ticks in mm; which way the beam travels; 100 mm in x and y, where the axis begins.
  drawAxes(t, captions, ink) {
    const { low, high } = ends(t);
    const y = -1.2 * t.active_radius;
    const lines = (vertices, layer) => {
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", new Float32BufferAttribute(vertices, 3));
      const o = new LineSegments(geometry, new LineBasicMaterial({ color: ink }));
      o.userData.layer = layer;
      captions.add(o);
    };
    const words = (text, at, layer) => { label(text, "axis", at, captions).userData.layer = layer; };

    const axis = [0, y, low - 40, 0, y, high + 40];
    for (let z = Math.ceil(low / ticksEvery) * ticksEvery; z <= high; z += ticksEvery) {
      axis.push(0, y, z, 0, y - 8, z);
      words(`${z}`, [0, y - 22, z], "z");
    }
    words("z [mm]", [0, y - 22, high + 62], "z");
    const from = t.beam_direction > 0 ? low - 150 : high + 150;
    const to = from + 90 * t.beam_direction;
    const head = to - 22 * t.beam_direction;
    axis.push(0, 0, from, 0, 0, to, 0, 0, to, 0, 9, head, 0, 0, to, 0, -9, head);
    words("beam", [0, 26, (from + to) / 2], "z");
    lines(axis, "z");

    const corner = low - 40;
    lines([0, y, corner, 100, y, corner, 0, y, corner, 0, y + 100, corner], "scale");
    words("x 100 mm", [128, y, corner], "scale");
    words("y 100 mm", [0, y + 116, corner], "scale");

    const middle = new Line(new BufferGeometry().setFromPoints([new Vector3(0, 0, low), new Vector3(0, 0, high)]),
      new LineDashedMaterial({ color: ink, dashSize: 14, gapSize: 10, transparent: true, opacity: 0.6 }));
    middle.computeLineDistances();
    captions.add(middle);
    label(`tracker ${t.tracker}${t.name ? ", " + t.name : ""}`, "tracker", [0, 1.36 * t.active_radius, (low + high) / 2], captions);
  }

  /// Draws an event in the place of the one before.
  drawEvent(event) {
    this.event = event;
    this.trackLines = [];
    for (const { event: group } of this.groups.values()) dispose(group);
    for (const t of this.detector) {
      const { event: group } = this.groups.get(t.tracker);
      const here = (o) => o.tracker === t.tracker;
      this.drawChannels(event.digits.filter(here), group);
      this.drawSpacePoints(event.space_points.filter(here), group);
      for (const particle of (event.truth ?? []).filter(here)) this.drawTruth(particle, group);
      event.tracks.forEach((track, i) => { if (here(track)) this.drawTrack(track, i, group); });
    }
    this.applyLayers();
    this.choose(null);
  }

  drawChannels(digits, group) {
    for (let plane = 0; plane < planeColours; ++plane) {
      const hits = digits.filter((d) => d.plane % planeColours === plane && d.from);
      if (hits.length === 0) continue;
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", new Float32BufferAttribute(hits.flatMap((d) => [...d.from, ...d.to]), 3));
      const lines = new LineSegments(geometry, new LineBasicMaterial({ color: new Color(colour(`plane-${plane}`)), transparent: true, opacity: 0.6 }));
      lines.userData = { layer: `channels-${plane}`, tell: (hit) => ({ digit: hits[Math.floor(hit.index / 2)] }) };
      group.add(lines);
    }
  }

  drawSpacePoints(points, group) {
    for (const triplets of [true, false]) {
      const found = points.filter((p) => (p.channels.length > 2) === triplets);
      if (found.length === 0) continue;
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", new Float32BufferAttribute(found.flatMap((p) => p.at), 3));
      const dots = new Points(geometry, new PointsMaterial({
        color: new Color(colour("point")), size: triplets ? 8 : 9, sizeAttenuation: false, map: disc(triplets), alphaTest: 0.4, transparent: true,
      }));
      dots.userData = { layer: "space points", tell: (hit) => ({ point: found[hit.index] }) };
      group.add(dots);
    }
  }

  polyline(points, style) {
    const geometry = new LineGeometry();
    geometry.setPositions(points.flat());
    const line = new Line2(geometry, new LineMaterial({ transparent: true, ...style }));
    line.computeLineDistances();
    return line;
  }

  drawTruth(particle, group) {
    if (particle.curve.length < 2) return;
    const line = this.polyline(particle.curve, { color: new Color(colour("truth")), linewidth: 2, dashed: true, dashSize: 12, gapSize: 8, depthWrite: false });
    line.renderOrder = 1;
    line.userData = { layer: "truth", tell: () => ({ particle }) };
    group.add(line);
  }

  drawTrack(track, index, group) {
    const name = `track-${index % trackColours}`;
    const line = this.polyline(track.curve.length > 1 ? track.curve : [[track.x[0], track.y[0], track.z], [track.x[0], track.y[0], track.z + 1]],
      { color: new Color(colour(name)), linewidth: pixelsOfTrack });
    line.renderOrder = 2;
    line.userData = { layer: "tracks", index, tell: () => ({ track: index }) };
    const end = track.curve.length > 0 ? track.curve.at(-1) : [track.x[0], track.y[0], track.z];
    const tag = label(`${track.track}`, "track", [end[0], end[1], end[2] + 34], group);
    tag.element.style.background = `var(--${name})`;
    tag.userData.layer = "tracks";
    group.add(line);
    this.trackLines[index] = { line, tag, track, group };
  }

  /// Brings one track (its index in the event) forward, or none.
  choose(index) {
    this.chosen = index;
    if (this.marks) {
      this.marks.removeFromParent();
      dispose(this.marks);
      this.marks = null;
    }
    this.trackLines.forEach(({ line, tag }, i) => {
      const dim = index !== null && i !== index;
      line.material.linewidth = i === index ? pixelsOfTrack * 1.8 : pixelsOfTrack;
      line.material.opacity = dim ? 0.3 : 1;
      tag.element.style.opacity = dim ? 0.35 : 1;
    });
    if (index !== null && this.trackLines[index]) {
      const { track, group } = this.trackLines[index];
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", new Float32BufferAttribute(track.points.flatMap((p) => p.at), 3));
      this.marks = new Group();
      this.marks.add(new Points(geometry, new PointsMaterial({
        color: new Color(colour(`track-${index % trackColours}`)), size: 13, sizeAttenuation: false, map: disc(false), alphaTest: 0.4, transparent: true,
      })));
      group.add(this.marks);
    }
    this.render();
  }

  layer(name, on) {
    if (on) this.shown.add(name);
    else this.shown.delete(name);
    this.applyLayers();
    this.render();
  }
  applyLayers() {
    for (const { frame } of this.groups.values()) {
      frame.traverse((o) => {
        const { layer } = o.userData;
        if (layer) o.visible = frame.visible && layer !== this.hidden && (layer === "z" || layer === "scale" || this.shown.has(layer));
        else if (o.isCSS2DObject) o.visible = frame.visible;
      });
    }
  }

  recolour() {
    const { event, chosen } = this;
    this.drawDetector();
    if (event) {
      this.drawEvent(event);
      this.choose(chosen);
    }
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.holder;
    if (width === 0 || height === 0) return;
    this.perspective.aspect = width / height;
    this.frame();
    this.renderer.setSize(width, height);
    this.labels.setSize(width, height);
    this.render();
  }

  render() {
    this.renderer.render(this.scene, this.camera);
    this.labels.render(this.scene, this.camera);
  }

  /// What is under a point of the window: tracks before points before true particles before channels.
  under(clientX, clientY) {
    const box = this.renderer.domElement.getBoundingClientRect();
    const ray = new Raycaster();
    ray.setFromCamera(new Vector2(((clientX - box.left) / box.width) * 2 - 1, 1 - ((clientY - box.top) / box.height) * 2), this.camera);
    const seen = this.camera === this.flat ? 2 * this.halfHeight / this.flat.zoom
      : 2 * Math.tan((this.perspective.fov * Math.PI) / 360) * this.camera.position.distanceTo(this.controls.target);
    const perPixel = seen / box.height;
    ray.params.Line2 = { threshold: 6 };
    ray.params.Line.threshold = 3 * perPixel;
    ray.params.Points.threshold = 5 * perPixel;
    const order = ["tracks", "space points", "truth", "channels"];
    const rank = (o) => order.findIndex((name) => o.userData.layer?.startsWith(name));
    const hits = ray.intersectObjects([...this.groups.values()].map((g) => g.event), true)
      .filter((h) => h.object.visible && h.object.userData.tell)
      .sort((a, b) => rank(a.object) - rank(b.object) || (a.distanceToRay ?? a.distance) - (b.distanceToRay ?? b.distance));
    return hits.length > 0 ? hits[0].object.userData.tell(hits[0]) : null;
  }

  listen() {
    const canvas = this.renderer.domElement;
    let pressed = null;
    canvas.addEventListener("pointerdown", (e) => { pressed = [e.clientX, e.clientY]; });
    canvas.addEventListener("pointerup", (e) => {
      // A press that moved was a turn of the picture.
      if (pressed && Math.hypot(e.clientX - pressed[0], e.clientY - pressed[1]) < 4) this.picked(this.under(e.clientX, e.clientY));
      pressed = null;
    });
    canvas.addEventListener("pointermove", (e) => {
      if (e.buttons === 0) this.hovered(this.under(e.clientX, e.clientY), e);
      else this.hovered(null, e);
    });
    canvas.addEventListener("pointerleave", (e) => this.hovered(null, e));
  }

  /// Where on the window a track is drawn: a point in the middle of its first long gap between stations.
  screenPosition(index) {
    const { line, track } = this.trackLines[index];
    const middle = track.curve[Math.floor(track.curve.length / 2)];
    const at = line.localToWorld(new Vector3(...middle)).project(this.camera);
    const box = this.renderer.domElement.getBoundingClientRect();
    return { x: box.left + ((at.x + 1) / 2) * box.width, y: box.top + ((1 - at.y) / 2) * box.height };
  }
}
