#include "tools/bench/subjects.h"

namespace patina::bench {

std::vector<Subject> named_subjects() {
    return {passes_subject(),   graph_subject(), render_subject(),  shade_subject(),
            segment_subject(),  rest_subject(),  refine_subject(),  hemi_subject(),
            examples_subject(), track_subject(), kinect2_subject(), record_subject()};
}

}  // namespace patina::bench
