#pragma once

#include <memory>

#include <glm/glm.hpp>

#include "patina/source.h"

namespace patina::sensor {

/// By how many metres, whole ones, a world is moved so that floats resolve it: where its first camera stands, beyond
/// 1 km from the origin; else 0.
glm::dvec3 world_offset_m(glm::dvec3 first_camera_m);

/// Another source's frames in a world that is moved: poses less an offset.
class RecentredSource : public Source {
  public:
    RecentredSource(std::unique_ptr<Source> source, glm::dvec3 offset_m)
        : source_(std::move(source)), offset_m_(offset_m) {}

    const SequenceInfo& info() const override { return source_->info(); }
    std::optional<Reading> next() override;

  private:
    std::unique_ptr<Source> source_;
    glm::dvec3 offset_m_;
};

}  // namespace patina::sensor
