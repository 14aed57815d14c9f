// Runs the Khronos glTF validator: node tools/validate_gltf.mjs FILE...
// Prints each file's counts and messages; exits with 1 on any error or warning, with 2 where a file cannot be read.
import {readFile} from 'node:fs/promises';
import process from 'node:process';

import validator from 'gltf-validator';

const kSeverities = ['error', 'warning', 'information', 'hint'];

/** Returns the number of errors and warnings in one file. */
async function validate(path) {
    const report = await validator.validateBytes(new Uint8Array(await readFile(path)), {uri: path});
    const {numErrors, numWarnings, numInfos, numHints, messages} = report.issues;
    console.log(`${path}: ${numErrors} errors, ${numWarnings} warnings, ${numInfos} informations, ${numHints} hints`);
    for (const {severity, code, message, pointer} of messages) {
        console.log(`  ${kSeverities[severity]} ${code} at ${pointer ?? 'the file'}: ${message}`);
    }
    return numErrors + numWarnings;
}

const paths = process.argv.slice(2);
if (paths.length === 0) {
    console.error('usage: node tools/validate_gltf.mjs FILE...');
    process.exit(2);
}
let found = 0;
for (const path of paths) {
    try {
        found += await validate(path);
    } catch (failure) {
        console.error(`${path}: cannot be validated: ${failure.message ?? failure}`);
        process.exit(2);
    }
}
process.exit(found === 0 ? 0 : 1);
