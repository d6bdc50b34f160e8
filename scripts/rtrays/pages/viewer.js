// SPDX-License-Identifier: MIT
// Compares the images of a run. The script images.js defines them: `images` is [{name, width, height, data}], where data
// is RGBE (Ward 1991), row by row from the top, in base64. Exposure and difference apply to linear values.
"use strict";

function viewer(root, images) {
  const decoded = new Map();

  // Linear R, G, B of an image, three floats per pixel.
  function pixels(image) {
    if (!decoded.has(image)) {
      const bytes = Uint8Array.from(atob(image.data), c => c.charCodeAt(0));
      const values = new Float32Array(3 * image.width * image.height);
      for (let i = 0; i < image.width * image.height; ++i) {
        const scale = bytes[4 * i + 3] ? 2 ** (bytes[4 * i + 3] - 136) : 0;
        for (let c = 0; c < 3; ++c) values[3 * i + c] = (bytes[4 * i + c] + 0.5) * scale;
      }
      decoded.set(image, values);
    }
    return decoded.get(image);
  }

  function element(tag, parent, properties = {}) {
    return parent.appendChild(Object.assign(document.createElement(tag), properties));
  }

  function choice(label, options, selected) {
    const box = element("label", controls, {textContent: label + " "});
    const select = element("select", box);
    options.forEach((text, i) => element("option", select, {value: i, textContent: text}));
    select.selectedIndex = selected;
    select.oninput = draw;
    return select;
  }

  function slider(label, min, max, step, value) {
    const box = element("label", controls, {textContent: label + " "});
    const input = element("input", box, {type: "range", min, max, step, value});
    const shown = element("output", box);
    input.oninput = draw;
    return {get value() { shown.textContent = input.value; return Number(input.value); }};
  }

  const controls = element("div", root, {className: "controls"});
  const names = images.map(image => image.name);
  const left = choice("left", names, 0);
  const right = choice("right", names, Math.min(1, images.length - 1));
  const mode = choice("show", ["split", "left", "right", "10 × |difference|"], 0);
  const exposure = slider("exposure, stops", -8, 8, 0.5, 0);
  const zoom = slider("zoom", 1, 8, 1, images[0].width < 200 ? 4 : 2);
  const frame = element("div", root, {className: "frame"});
  const canvas = element("canvas", frame);
  const readout = element("p", root, {className: "readout"});
  let split = 0.5;

  // sRGB's transfer curve, for the eye only.
  function encode(linear) {
    const x = Math.min(Math.max(linear, 0), 1);
    return 255 * (x <= 0.0031308 ? 12.92 * x : 1.055 * x ** (1 / 2.4) - 0.055);
  }

  function draw() {
    const [a, b] = [images[left.value], images[right.value]];
    const [p, q] = [pixels(a), pixels(b)];
    const gain = 2 ** exposure.value;
    const {width, height} = a;
    canvas.width = width;
    canvas.height = height;
    canvas.style.width = `${width * zoom.value}px`;
    const context = canvas.getContext("2d");
    const shown = context.createImageData(width, height);
    const show = Number(mode.value);
    for (let i = 0; i < width * height; ++i) {
      const from = show === 1 || (show === 0 && i % width < split * width) ? p : q;
      for (let c = 0; c < 3; ++c) {
        const k = 3 * i + c;
        shown.data[4 * i + c] = encode(gain * (show === 3 ? 10 * Math.abs(p[k] - q[k]) : from[k]));
      }
      shown.data[4 * i + 3] = 255;
    }
    context.putImageData(shown, 0, 0);
  }

  canvas.onpointermove = event => {
    const a = images[left.value], b = images[right.value];
    const box = canvas.getBoundingClientRect();
    const x = Math.min(Math.max(Math.floor((event.clientX - box.left) / box.width * a.width), 0), a.width - 1);
    const y = Math.min(Math.max(Math.floor((event.clientY - box.top) / box.height * a.height), 0), a.height - 1);
    const at = image => Array.from(pixels(image).slice(3 * (y * a.width + x), 3 * (y * a.width + x) + 3), v => v.toPrecision(3));
    readout.textContent = `(${x}, ${y})  left ${at(a).join(" ")}  right ${at(b).join(" ")}`;
    if (Number(mode.value) === 0) {
      split = (event.clientX - box.left) / box.width;
      draw();
    }
  };
  draw();
}
