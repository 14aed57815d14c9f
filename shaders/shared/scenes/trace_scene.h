// What a camera sees of a synthetic scene: first hits, and their light.
#ifndef PATINA_SHARED_TRACE_SCENE_H
#define PATINA_SHARED_TRACE_SCENE_H
#include "shared/input/camera.h"
#include "shared/scenes/scene.h"
INTEROP_BEGIN

struct TraceSceneParams {
    Camera camera;
};

INTEROP_END
#endif
