# Shortens `ctest --verbose`: one line per test, the output of tests that failed without what GoogleTest prints of TESTs
# that passed, the reason of tests that were skipped, and ctest's summary unchanged.
/^( *Start +[0-9]+:|Done constructing|Added [0-9]+ tests|Check(ing|ed) test dep|Parse Config|test [0-9]+|UpdateCTestConfiguration|Constructing|Updating test list|Test timeout|Working Directory|Environment variables|Test command)/ { next }
/^[0-9]+: / {
    number = $1 + 0
    if (/^[0-9]+: \[----------\]/) next
    if (/^[0-9]+: \[ RUN      \]/) { running[number] = $0 "\n"; next }
    if (/^[0-9]+: \[       OK \]/) { running[number] = ""; next }
    if (/^[0-9]+: \[  SKIPPED \] .* \(/) skipped[number] = skipped[number] running[number] $0 "\n"
    output[number] = output[number] running[number] $0 "\n"
    running[number] = ""
    if (after_skip[number]) {
        reason[number] = reason[number] " " substr($0, length($1) + 2)
        after_skip[number] = 0
    }
    if (/: Skipped$/) after_skip[number] = 1
    if (/^[0-9]+: Skipped: /) reason[number] = substr($0, index($0, "Skipped: ") + 8)
    next
}
/ Test +#[0-9]+: / {
    print
    match($0, /#[0-9]+/)
    number = substr($0, RSTART + 1, RLENGTH - 1) + 0
    if (/\*\*\*Skipped/) print "          skipped:" reason[number]
    else if (/\*\*\*/) printf "%s", output[number] running[number]
    else printf "%s", skipped[number]
    delete output[number]
    delete skipped[number]
    delete running[number]
    fflush()
    next
}
/^The following tests passed:/ { passed = 1 }
/tests passed,|^No tests/ { summary = 1 }
passed && !summary { next }
summary || NF
