#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "patina/reconstruction.h"
#include "reconstruction/model_view.h"
#include "tools/viewer/free_camera.h"
#include "tools/viewer/layers.h"

namespace patina::tools {

/// What the model has at a pixel that the user clicked.
struct PickedSurface {
    glm::vec3 position_m{0}, normal{0};
    uint32_t label = 0;
    std::optional<glm::vec3> kd, ks;
    float alpha = 0;         ///< where ks is known
    float observations = 0;  ///< of the voxels around
    float certainty = 0;
    bool hit = false;
};

/// What the user has chosen, and asks for.
struct ViewerState {
    Layer layer = Layer::kColor;
    float exposure = 1;
    bool follow = true;  ///< the view is the sensor's; else that of `camera`
    FreeCamera camera;
    std::optional<OtherLights> other;  ///< what the user made of the lights; empty: those of the reconstruction
    std::optional<size_t> held_light;  ///< under the mouse while it is dragged
    std::optional<PickedSurface> picked;
    bool paused = false;
    bool help = false;
    bool export_asked = false;   ///< until whoever runs the viewer has done it
    bool record_asked = false;   ///< likewise: a recording is to begin, or to end
    bool undo_asked = false;     ///< likewise: back to the last checkpoint
    bool shadows_asked = false;  ///< likewise: shadows of the lights as they are now
};

/// How long a pass takes, as the mean over the last frames.
struct PassMean {
    std::string name;
    double ms = 0;
};

/// A button of the user's.
struct Button {
    bool shown = false;
    std::string lacks;  ///< why it cannot be pressed; empty where it can

    bool can() const { return shown && lacks.empty(); }
};

/// What the user is shown besides the picture.
struct ViewerFacts {
    std::vector<std::pair<std::string, std::string>> lines;  ///< what, and how it is now
    std::vector<PoolUse> pools;
    std::vector<PassMean> passes;  ///< the slowest first
    std::string message;           ///< of the last thing that was done
    bool can_pause = false, can_export = false, can_cast_shadows = false;
    Button record, undo;
    bool recording = false;
    bool reflectance = false, segmentation = false;  ///< the model has them
};

}  // namespace patina::tools
