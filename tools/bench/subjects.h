#pragma once

#include <vector>

#include "tools/bench/subject.h"

namespace patina::bench {

/// The whole pipeline on a built-in scene, with all stages on: what `patina bench` measures without a subject.
Subject pipeline_subject();

/// Each in the file of its name.
Subject passes_subject();
Subject graph_subject();
Subject render_subject();
Subject shade_subject();
Subject segment_subject();
Subject rest_subject();
Subject refine_subject();
Subject hemi_subject();
Subject examples_subject();
Subject track_subject();
Subject kinect2_subject();
Subject record_subject();

/// All that have a name, in the order of --help.
std::vector<Subject> named_subjects();

}  // namespace patina::bench
