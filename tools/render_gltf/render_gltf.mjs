// Renders the scene.glb of a run with three.js or Babylon.js in headless Chromium, from the pose of a recorded frame:
//   node tools/render_gltf/render_gltf.mjs [--with three|babylon] RUN SEQUENCE FRAME OUT.png [EXPOSURE]
// RUN holds scene.glb and trajectory.txt, SEQUENCE sequence.json. The lights are those of the file, brought from candela
// back to the recording's pixel value, so that the picture is comparable with that of `patina render`. Needs npm's three,
// Chromium (Debian: chromium), and for Babylon.js: npm install --no-save babylonjs@7 babylonjs-loaders@7
import {spawn} from 'node:child_process';
import {mkdtemp, readFile, rename, rm, writeFile} from 'node:fs/promises';
import {createServer} from 'node:http';
import {tmpdir} from 'node:os';
import {dirname, extname, join, normalize} from 'node:path';
import process from 'node:process';
import {fileURLToPath} from 'node:url';

const kHere = dirname(fileURLToPath(import.meta.url)), kRoot = join(kHere, '../..');
const kTimeoutMs = 180_000;
const kPages = {three: 'three.html', babylon: 'babylon.html'};
const kTypes = {'.js': 'text/javascript', '.html': 'text/html', '.glb': 'model/gltf-binary'};

class UserError extends Error {}

/** Reads a file, or says in one sentence which one could not be read. */
async function read(path, encoding) {
    try {
        return await readFile(path, encoding);
    } catch (failure) {
        throw new UserError(`${path}: cannot be read (${failure.code})`);
    }
}

/** Pose number `frame` of a TUM trajectory: [tx, ty, tz, qx, qy, qz, qw], camera to world. */
async function poseOf(path, frame) {
    const lines = (await read(path, 'utf8')).split('\n').filter((line) => line.trim() && !line.startsWith('#'));
    if (!(frame < lines.length)) throw new UserError(`${path}: has ${lines.length} poses, frame ${frame} is asked for`);
    const numbers = lines[frame].trim().split(/\s+/).slice(1).map(Number);
    if (numbers.length !== 7 || !numbers.every(Number.isFinite)) {
        throw new UserError(`${path}: pose ${frame} is '${lines[frame]}', not a timestamp and seven numbers`);
    }
    return numbers;
}

/** What the page needs to know: colour camera and its pose's parts, and exposure. */
async function viewOf(run, sequence, frame, exposure) {
    const path = join(sequence, 'sequence.json');
    let description;
    try {
        description = JSON.parse(await read(path, 'utf8'));
    } catch (failure) {
        if (failure instanceof UserError) throw failure;
        throw new UserError(`${path}: is not JSON (${failure.message})`);
    }
    const {color, depth_to_color: colorFromDepth} = description;
    return {camera: color, colorFromDepth, pose: await poseOf(join(run, 'trajectory.txt'), frame), exposure};
}

/** Serves page, view, scene and libraries on this machine alone; `done` gets the picture, or an Error. */
function serve(page, view, scene, done) {
    const server = createServer(async (request, response) => {
        const answer = (body, type) => response.writeHead(200, {'Content-Type': type}).end(body);
        const body = async () => {
            const parts = [];
            for await (const part of request) parts.push(part);
            return Buffer.concat(parts);
        };
        try {
            const path = normalize(new URL(request.url, 'http://localhost').pathname);
            if (path === '/') answer(await read(join(kHere, page)), kTypes['.html']);
            else if (path === '/view.js') answer(await read(join(kHere, 'view.js')), kTypes['.js']);
            else if (path === '/view.json') answer(JSON.stringify(view), 'application/json');
            else if (path === '/scene.glb') answer(scene, kTypes['.glb']);
            else if (path === '/picture') answer('', 'text/plain') && done(await body());
            else if (path === '/failure') answer('', 'text/plain') && done(new UserError((await body()).toString()));
            else if (/^\/(three|babylonjs|babylonjs-loaders)\//.test(path)) {
                answer(await read(join(kRoot, 'node_modules', path)), kTypes[extname(path)] ?? 'text/plain');
            } else response.writeHead(404).end();
        } catch (failure) {
            response.writeHead(404).end();
            done(failure);
        }
    });
    return new Promise((resolve) => server.listen(0, '127.0.0.1', () => resolve(server)));
}

/** Opens an address in headless Chromium with software rendering. */
function browse(address, profile) {
    const switches = ['--headless=new', '--no-sandbox', '--disable-quic', '--no-first-run', '--disable-sync',
                      '--disable-background-networking', '--disable-component-update', '--use-gl=angle',
                      '--use-angle=swiftshader', '--enable-unsafe-swiftshader', `--user-data-dir=${profile}`];
    return spawn('chromium', [...switches, address], {stdio: 'ignore'});
}

async function picture(page, view, scene) {
    const profile = await mkdtemp(join(tmpdir(), 'render-gltf-'));
    let server, browser, timer;
    try {
        return await new Promise(async (resolve, reject) => {
            const done = (result) => (result instanceof Error ? reject(result) : resolve(result));
            server = await serve(page, view, scene, done);
            browser = browse(`http://127.0.0.1:${server.address().port}/`, profile);
            browser.on('error', (failure) => reject(new UserError(`chromium cannot be started (${failure.code})`)));
            browser.on('exit', (code) => reject(new UserError(`chromium ended with ${code} before it had a picture`)));
            timer = setTimeout(() => reject(new UserError(`no picture after ${kTimeoutMs / 1000} s`)), kTimeoutMs);
        });
    } finally {
        clearTimeout(timer);
        browser?.removeAllListeners('exit').kill('SIGKILL');
        server?.closeAllConnections();
        server?.close();
        await rm(profile, {recursive: true, force: true, maxRetries: 5});
    }
}

async function main(given) {
    const [renderer, words] = given[0] === '--with' ? [given[1], given.slice(2)] : ['three', given];
    const [run, sequence, frame, out, exposure = '1'] = words;
    if (!out || !(renderer in kPages) || !/^\d+$/.test(frame) || !(Number(exposure) > 0)) {
        throw new UserError('usage: node tools/render_gltf/render_gltf.mjs [--with three|babylon] RUN SEQUENCE FRAME '
                            + 'OUT.png [EXPOSURE]');
    }
    const view = await viewOf(run, sequence, Number(frame), Number(exposure));
    const pixels = await picture(kPages[renderer], view, await read(join(run, 'scene.glb')));
    await writeFile(`${out}.partial`, pixels);
    await rename(`${out}.partial`, out);
}

main(process.argv.slice(2)).catch((failure) => {
    console.error(failure instanceof UserError ? `render_gltf: ${failure.message}` : failure);
    process.exitCode = 1;
});
