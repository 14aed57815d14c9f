// Shows a scene that stands in this page: plain WebGL 2, no library, no network.
'use strict';

const kMost = 64;  // lamps that the shader takes
const kOwnSliders = 8;

const scene = JSON.parse(document.getElementById('scene').textContent);
const kNotes = [
    `${scene.lights.length ? 'Under the lamps of the recording, without shadows' : 'No lamp is known: lit from all around'}. Click a surface to see its material.`,
    'Diffuse albedo: what a surface reflects in all directions, without light and shadow.',
    'Specular albedo: how strong highlights are. Hatched: gloss was not observed.',
    'Roughness: black is a sharp highlight, white a wide one. Hatched: gloss was not observed.',
    'Segments: parts with one material each.',
];
const canvas = document.getElementById('view');
const note = document.getElementById('note');
const embedded = window.parent !== window;
document.documentElement.classList.toggle('embedded', embedded);

function bytesOf(id) {
    const text = atob(document.getElementById(id).textContent);
    const bytes = new Uint8Array(text.length);
    for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
    return bytes;
}

/* Vectors and matrices of three and four, column by column. */
const add = (a, b, scale = 1) => a.map((v, i) => v + scale * b[i]);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => a.map((v) => v / Math.hypot(...a));

function product(a, b) {
    const result = new Float32Array(16);
    for (let column = 0; column < 4; ++column)
        for (let row = 0; row < 4; ++row)
            for (let i = 0; i < 4; ++i) result[4 * column + row] += a[4 * i + row] * b[4 * column + i];
    return result;
}

/* The camera turns about a point. */
const size_m = add(scene.high, scene.low, -1);
const radius_m = Math.max(Math.hypot(...size_m) / 2, 1e-3);
const start = {target: add(scene.low, size_m, 0.5), distance: 1.8 * radius_m, ...scene.start};
let camera = structuredClone(start);

function eyeOf() {
    const level = Math.cos(camera.pitch);
    const back = [level * Math.sin(camera.yaw), Math.sin(camera.pitch), level * Math.cos(camera.yaw)];
    return add(camera.target, back, camera.distance);
}

function axesOf(eye) {
    const back = unit(add(eye, camera.target, -1)), right = unit(cross([0, 1, 0], back));
    return {right, up: cross(back, right), back};
}

function clipFromWorld(eye) {
    const {right, up, back} = axesOf(eye);
    const view = [right[0], up[0], back[0], 0, right[1], up[1], back[1], 0, right[2], up[2], back[2], 0,
        -dot(right, eye), -dot(up, eye), -dot(back, eye), 1];
    const aspect = canvas.width / canvas.height, focal = 1.9 * Math.min(1, aspect);
    const near = 0.02 * camera.distance, far = camera.distance + 4 * radius_m;
    const projection = [focal / aspect, 0, 0, 0, 0, focal, 0, 0, 0, 0, (far + near) / (near - far), -1,
        0, 0, 2 * far * near / (near - far), 0];
    return product(projection, view);
}

/* What the shaders get. */
const gl = canvas.getContext('webgl2', {antialias: true, alpha: true});
let surface, lamp, groups = [], lampArray, materialTexture;
let mode = 0;
const light = {exposure: 0, ambient: 1, lamps: scene.lights.slice(0, kMost).map(() => 1)};

function programOf(name) {
    const program = gl.createProgram();
    for (const [kind, type] of [['vert', gl.VERTEX_SHADER], ['frag', gl.FRAGMENT_SHADER]]) {
        const shader = gl.createShader(type);
        gl.shaderSource(shader, document.getElementById(`${name}.${kind}`).textContent.trim());
        gl.compileShader(shader);
        gl.attachShader(program, shader);
        if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader));
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program));
    return {program, at: (uniform) => gl.getUniformLocation(program, uniform)};
}

function groupOf(group, bytes) {
    const array = gl.createVertexArray(), kVertex = 16;
    gl.bindVertexArray(array);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, bytes.subarray(group.vertices, group.triangles), gl.STATIC_DRAW);
    for (let i = 0; i < 4; ++i) gl.enableVertexAttribArray(i);
    gl.vertexAttribPointer(0, 3, gl.UNSIGNED_SHORT, true, kVertex, 0);
    gl.vertexAttribIPointer(1, 1, gl.UNSIGNED_SHORT, kVertex, 6);
    gl.vertexAttribPointer(2, 2, gl.SHORT, true, kVertex, 8);
    gl.vertexAttribIPointer(3, 2, gl.UNSIGNED_SHORT, kVertex, 12);
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, bytes.subarray(group.triangles, group.end), gl.STATIC_DRAW);
    return {array, indices: (group.end - group.triangles) / 4, page: group.page, texture: null};
}

/* The same colour for a label as in the pictures of the report. */
function labelColor(label) {
    if (label === 0) return [0.22, 0.22, 0.22];
    const turn = (label * 0.61803398875) % 1, lightness = 0.55 + 0.15 * (label % 3);
    return [0, 1 / 3, 2 / 3].map((phase) =>
        Math.min(1, lightness * (0.25 + 0.75 * (0.5 + 0.5 * Math.cos(2 * Math.PI * (turn - phase))))));
}

function materialTable() {
    const rows = scene.materials.flatMap((m) => [
        m.kdOverBase, m.alpha ?? 1, m.observed ? 1 : 0, m.reflects ? 1 : 0,
        ...(m.ks ?? [0, 0, 0]), 0, ...labelColor(m.label), 0]);
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, 3, Math.max(scene.materials.length, 1), 0, gl.RGBA, gl.FLOAT,
        new Float32Array(rows.length ? rows : 12));
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    return texture;
}

async function pageTexture(number) {
    const element = document.getElementById(`page-${number}`);
    const picture = new Image();
    picture.src = `data:${element.dataset.mime};base64,${element.textContent}`;
    await picture.decode();
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.SRGB8_ALPHA8, gl.RGBA, gl.UNSIGNED_BYTE, picture);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
    gl.generateMipmap(gl.TEXTURE_2D);
    return texture;
}

async function load() {
    surface = programOf('surface');
    lamp = programOf('lamp');
    const bytes = bytesOf('arrays');
    groups = scene.groups.map((group) => groupOf(group, bytes));
    materialTexture = materialTable();
    lampArray = gl.createVertexArray();
    gl.bindVertexArray(lampArray);
    gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(scene.lights.flatMap((l) => l.position)), gl.STATIC_DRAW);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
    light.exposure = usualExposure(bytes);
    for (const group of groups) if (group.page !== null) group.texture = await pageTexture(group.page);
}

/* Stops that bring the mean of a grey surface to a usual brightness, where the recording's own is far from it. */
function usualExposure(bytes) {
    let sum = 0, count = 0;
    for (const group of scene.groups) {
        const words = new Uint16Array(bytes.slice(group.vertices, group.triangles).buffer);
        for (let i = 0; i < words.length; i += 8 * 97, ++count) {
            const at = [0, 1, 2].map((k) => scene.low[k] + words[i + k] / 65535 * size_m[k]);
            for (const l of scene.lights) {
                const offset = add(l.position, at, -1), distance2 = dot(offset, offset);
                const emission = dot(l.axis, l.axis) ? Math.max(-dot(l.axis, offset), 0) / Math.sqrt(Math.max(distance2, 1e-12)) : 1;
                sum += 0.25 * emission * l.intensity[1] / Math.max(distance2, 0.04) / Math.PI;
            }
            sum += 0.4 * scene.ambient[1];
        }
    }
    const mean = sum / Math.max(count, 1);
    return mean > 0 && (mean < 0.1 || mean > 0.4) ? Math.round(2 * Math.log2(0.25 / mean)) / 2 : 0;
}

function draw(shown = mode) {
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    const width = Math.max(1, Math.round(canvas.clientWidth * ratio)), height = Math.max(1, Math.round(canvas.clientHeight * ratio));
    if (canvas.width !== width || canvas.height !== height) [canvas.width, canvas.height] = [width, height];
    gl.viewport(0, 0, width, height);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.enable(gl.CULL_FACE);
    const eye = eyeOf(), clip = clipFromWorld(eye);
    drawSurface(shown, eye, clip);
    if (shown === 0 && scene.lights.length) {
        gl.useProgram(lamp.program);
        gl.uniformMatrix4fv(lamp.at('clip_from_world'), false, clip);
        gl.uniform1f(lamp.at('size_px'), 12 * ratio);
        gl.bindVertexArray(lampArray);
        gl.drawArrays(gl.POINTS, 0, scene.lights.length);
    }
}

function drawSurface(shown, eye, clip) {
    const lights = scene.lights.slice(0, kMost);
    gl.useProgram(surface.program);
    gl.uniformMatrix4fv(surface.at('clip_from_world'), false, clip);
    gl.uniform3fv(surface.at('low_m'), scene.low);
    gl.uniform3fv(surface.at('size_m'), size_m);
    gl.uniform3fv(surface.at('eye_m'), eye);
    gl.uniform3fv(surface.at('ambient'), scene.ambient.map((v) => v * light.ambient));
    gl.uniform1f(surface.at('exposure'), 2 ** light.exposure);
    gl.uniform1i(surface.at('mode'), shown);
    gl.uniform1i(surface.at('light_count'), lights.length);
    if (lights.length) {
        gl.uniform3fv(surface.at('light_m'), lights.flatMap((l) => l.position));
        gl.uniform3fv(surface.at('light_axis'), lights.flatMap((l) => l.axis));
        gl.uniform3fv(surface.at('light_intensity'), lights.flatMap((l, i) => l.intensity.map((v) => v * light.lamps[i])));
    }
    gl.uniform1i(surface.at('page'), 0);
    gl.uniform1i(surface.at('materials'), 1);
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, materialTexture);
    gl.activeTexture(gl.TEXTURE0);
    for (const group of groups) {
        gl.uniform1i(surface.at('has_page'), group.texture ? 1 : 0);
        gl.bindTexture(gl.TEXTURE_2D, group.texture);
        gl.bindVertexArray(group.array);
        gl.drawElements(gl.TRIANGLES, group.indices, gl.UNSIGNED_INT, 0);
    }
}

let waiting = false;
function redraw() {
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => {
        waiting = false;
        draw();
    });
}

/* What the user does. */
function setMode(chosen) {
    const button = document.querySelector(`#bar button[data-mode="${chosen}"]`);
    if (!button || button.disabled) return;
    mode = chosen;
    for (const each of document.querySelectorAll('#bar button')) each.setAttribute('aria-pressed', each === button);
    note.textContent = kNotes[mode];
    redraw();
}

function turn(yaw, pitch) {
    camera.yaw += yaw;
    camera.pitch = Math.min(1.55, Math.max(-1.55, camera.pitch + pitch));
    redraw();
}

function approach(factor) {
    camera.distance = Math.min(8 * radius_m, Math.max(0.02 * radius_m, camera.distance * factor));
    redraw();
}

/* By parts of the picture's height. */
function move(right, up) {
    const axes = axesOf(eyeOf());
    camera.target = add(add(camera.target, axes.right, right * camera.distance), axes.up, up * camera.distance);
    redraw();
}

/* Says what is under a point of the canvas. */
function pick(x, y) {
    draw(5);
    const ratio = canvas.width / canvas.clientWidth, pixel = new Uint8Array(4);
    gl.readPixels(Math.round(x * ratio), canvas.height - 1 - Math.round(y * ratio), 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    draw();
    const material = pixel[2] === 255 && pixel[3] === 255 ? scene.materials[pixel[0] + 256 * pixel[1]] : undefined;
    note.textContent = material ? describe(material) : kNotes[mode];
}

function describe(material) {
    if (!material.reflects) return `${material.name}: colour alone, no lamps were known`;
    if (!material.observed || !material.ks) return `${material.name}: gloss not observed`;
    return `${material.name}: ks ${material.ks.map((v) => v.toFixed(3)).join(' ')}, alpha ${material.alpha.toFixed(3)}`;
}

const pointers = new Map();
let pressed = null;

canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, [event.offsetX, event.offsetY]);
    pressed = pointers.size === 1 ? [event.offsetX, event.offsetY] : null;
});

canvas.addEventListener('pointermove', (event) => {
    const before = pointers.get(event.pointerId);
    if (!before) return;
    const now = [event.offsetX, event.offsetY], height = canvas.clientHeight;
    const right = now[0] - before[0], down = now[1] - before[1];
    if (pointers.size === 1) {
        if (event.buttons & 2 || event.shiftKey) move(-right / height, down / height);
        else turn(-6 * right / height, 6 * down / height);
    } else {
        const other = [...pointers].find(([id]) => id !== event.pointerId)[1];
        const distance = (p) => Math.max(Math.hypot(p[0] - other[0], p[1] - other[1]), 1);
        approach(distance(before) / distance(now));
        move(-right / 2 / height, down / 2 / height);
    }
    pointers.set(event.pointerId, now);
});

for (const name of ['pointerup', 'pointercancel']) {
    canvas.addEventListener(name, (event) => {
        pointers.delete(event.pointerId);
        const still = pressed && Math.hypot(event.offsetX - pressed[0], event.offsetY - pressed[1]) < 4;
        if (name === 'pointerup' && still) pick(event.offsetX, event.offsetY);
        pressed = null;
    });
}

canvas.addEventListener('wheel', (event) => {
    if (embedded && document.activeElement !== canvas && !event.ctrlKey) return;  // the page scrolls
    event.preventDefault();
    approach(Math.exp(0.0015 * event.deltaY * (event.deltaMode === 1 ? 16 : 1)));
}, {passive: false});
canvas.addEventListener('contextmenu', (event) => event.preventDefault());

const kKeys = {
    ArrowLeft: () => turn(-0.1, 0), ArrowRight: () => turn(0.1, 0), ArrowUp: () => turn(0, 0.1), ArrowDown: () => turn(0, -0.1),
    '+': () => approach(0.85), '=': () => approach(0.85), '-': () => approach(1 / 0.85),
    a: () => move(-0.05, 0), d: () => move(0.05, 0), w: () => move(0, 0.05), s: () => move(0, -0.05),
    Home: () => { camera = structuredClone(start); redraw(); },
};
document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.target.tagName === 'INPUT') return;
    if (event.key >= '1' && event.key <= '5') setMode(Number(event.key) - 1);
    else if (kKeys[event.key]) kKeys[event.key]();
    else return;
    event.preventDefault();
});

/* Sliders: exposure, ambient light, lamps from the brightest on; those that are many have one in common. */
function addSlider(name, low, high, step, value, text, change) {
    const label = document.createElement('label'), input = document.createElement('input'), output = document.createElement('output');
    Object.assign(input, {type: 'range', min: low, max: high, step, value});
    output.textContent = text(value);
    input.addEventListener('input', () => {
        output.textContent = text(input.valueAsNumber);
        change(input.valueAsNumber);
        redraw();
    });
    label.append(name, input, output);
    document.getElementById('sliders').append(label);
}

function addSliders() {
    const percent = (v) => `${Math.round(100 * v)} %`;
    addSlider('Exposure', -4, 8, 0.5, light.exposure, (v) => `${v > 0 ? '+' : ''}${v}`, (v) => { light.exposure = v; });
    if (Math.max(...scene.ambient) > 0) addSlider('All around', 0, 3, 0.05, 1, percent, (v) => { light.ambient = v; });
    const order = light.lamps.map((_, i) => i).sort((a, b) => dot(scene.lights[b].intensity, [1, 1, 1]) - dot(scene.lights[a].intensity, [1, 1, 1]));
    order.slice(0, kOwnSliders).forEach((lampNumber) =>
        addSlider(`Lamp ${lampNumber + 1}`, 0, 3, 0.05, 1, percent, (v) => { light.lamps[lampNumber] = v; }));
    const others = order.slice(kOwnSliders);
    if (others.length) addSlider(`${others.length} others`, 0, 3, 0.05, 1, percent, (v) => { for (const i of others) light.lamps[i] = v; });
}

function begin() {
    for (const button of document.querySelectorAll('#bar button')) {
        const number = Number(button.dataset.mode);
        button.addEventListener('click', () => setMode(number));
        const needs = [true, true, scene.materials.some((m) => m.reflects), scene.materials.some((m) => m.reflects), scene.materials.length > 1];
        button.disabled = !needs[number];
    }
    addSliders();
    setMode(0);
    new ResizeObserver(redraw).observe(canvas);
}

if (!gl) {
    note.textContent = 'This browser has no WebGL 2, which this view needs.';
} else {
    load().then(begin).catch((failure) => { note.textContent = `The view cannot be shown: ${failure.message}`; });
}
