#include "tools/run/frame_dumps.h"

#include <algorithm>

#include <fmt/format.h>

#include "tools/report/previews.h"
#include "tools/report/run_id.h"

namespace patina::tools {

namespace {

constexpr uint32_t kPreviews = 4;

Image<glm::vec3> rgb_of(const Image<glm::vec4>& image) {
    Image<glm::vec3> rgb(image.extent());
    std::transform(image.pixels().begin(), image.pixels().end(), rgb.pixels().begin(),
                   [](glm::vec4 pixel) { return glm::vec3(pixel); });
    return rgb;
}

/// What the model reflects; 0 where that is unknown, so that leaving hard pixels out does not pay.
void add_reflectance(FrameDump& dump, const ModelView::Reflectance& reflectance) {
    dump.kd = rgb_of(reflectance.model_kd);
    dump.ks = rgb_of(reflectance.ks_alpha);
    dump.rgb = rgb_of(reflectance.model_rgb);
    dump.kd_shown = rgb_of(reflectance.kd);
    dump.rgb_shown = rgb_of(reflectance.rgb);
    dump.alpha = Image<float>(dump.kd.extent());
    dump.label = Image<float>(dump.kd.extent());
    dump.visibility = Image<float>(dump.kd.extent());
    dump.kd_segment = dump.rgb_segment = Image<glm::vec3>(dump.kd.extent());
    for (size_t i = 0; i < dump.kd.extent().area(); ++i) {
        dump.alpha.pixels()[i] = reflectance.ks_alpha.pixels()[i].a;
        const uint32_t label = reflectance.label.pixels()[i];
        dump.label.pixels()[i] = static_cast<float>(label);
        if (label < reflectance.segment_kd.size())
            dump.kd_segment.pixels()[i] = reflectance.segment_kd[label].value_or(glm::vec3(0));
        // Of the radiance, kd makes up this much; the rest is the highlight.
        const glm::vec4 light = reflectance.light.pixels()[i];
        const glm::vec3 exchanged = dump.kd_segment.pixels()[i] - dump.kd.pixels()[i];
        dump.rgb_segment.pixels()[i] = glm::max(dump.rgb.pixels()[i] + exchanged * glm::vec3(light), 0.0f);
        dump.visibility.pixels()[i] = light.a;
    }
}

void visit_pair(graph::StateVisitor& visitor, const std::string& name, const std::string& caption, PicturePair& pair) {
    pair.caption = caption;
    visitor.value(name + ".extent", pair.extent);
    visitor.text(name + ".recorded", pair.recorded);
    visitor.text(name + ".rendered", pair.rendered);
}

}  // namespace

FrameDump to_dump(const ModelView& view) {
    const Extent2D extent = view.position_m.extent();
    FrameDump dump{Image<glm::vec3>(extent), Image<float>(extent), Image<glm::vec3>(extent), Image<float>(extent)};
    for (size_t i = 0; i < extent.area(); ++i) {
        dump.depth_m.pixels()[i] = view.position_m.pixels()[i].w;
        dump.valid.pixels()[i] = view.position_m.pixels()[i].w > 0 ? 1.0f : 0.0f;
        dump.normal.pixels()[i] = glm::vec3(view.normal.pixels()[i]);
        dump.rgb.pixels()[i] = glm::vec3(view.color.pixels()[i]);
    }
    if (view.reflectance) add_reflectance(dump, *view.reflectance);
    if (!view.label.empty()) {
        dump.label = Image<float>(extent);
        std::transform(view.label.pixels().begin(), view.label.pixels().end(), dump.label.pixels().begin(),
                       [](uint32_t label) { return static_cast<float>(label); });
    }
    return dump;
}

FrameDumps::FrameDumps(OutputFolder& folder, std::optional<uint32_t> frames, uint32_t dump_every)
    : folder_(folder), dump_every_(dump_every) {
    // At the end of each quarter, when the model holds what the camera has seen so far; where the end is not known,
    // after a second of video, and always four times as late.
    for (uint32_t i = 1, live = 30; i <= kPreviews; ++i, live *= 4) {
        const uint32_t at = frames ? static_cast<uint32_t>(uint64_t{*frames} * i / kPreviews) : live;
        preview_at_.push_back(at > 0 ? at - 1 : 0);
    }
}

void FrameDumps::after(Pipeline& pipeline, const SequenceInfo& info, const Frame& frame) {
    const bool dump = dump_every_ > 0 && frame.index % dump_every_ == 0;
    bool preview = false;
    while (!preview_at_.empty() && preview_at_.front() <= frame.index) {
        preview = true;
        preview_at_.pop_front();
    }
    if (dump || preview) {
        const RigidTransform world_from_color = *frame.world_from_camera * rigid_inverse(info.color_from_depth);
        owed_.push_back({frame.index, pipeline.view(info.color, world_from_color), dump,
                         preview ? std::optional(frame.color) : std::nullopt});
    }
    for (; !owed_.empty() && owed_.front().view.ready(); owed_.pop_front()) write(owed_.front());
}

void FrameDumps::finish() {
    for (; !owed_.empty(); owed_.pop_front()) write(owed_.front());
}

void FrameDumps::visit(graph::StateVisitor& visitor) {
    finish();
    std::vector<uint32_t> preview_at(preview_at_.begin(), preview_at_.end());
    std::vector<std::string> captions;
    for (const ReportPicture& preview : previews_) captions.push_back(preview.caption);
    visitor.values("run.preview_at", preview_at);
    visitor.texts("run.preview_captions", captions);
    visitor.texts("run.dumped", dumped_);
    visitor.text("run.dump_problem", problem_);
    visitor.value("run.dump_every", dump_every_);
    preview_at_.assign(preview_at.begin(), preview_at.end());
    previews_.resize(captions.size());
    pairs_.resize(captions.size());
    for (size_t i = 0; i < captions.size(); ++i) {
        previews_[i].caption = captions[i];
        visitor.text(fmt::format("run.preview_{}", i), previews_[i].png);
        visit_pair(visitor, fmt::format("run.pair_{}", i), captions[i], pairs_[i]);
    }
}

void FrameDumps::stamp(const std::string& run_id) const {
    for (const std::string& name : dumped_) stamp_run_id(folder_.published(name), run_id);
}

void FrameDumps::write(const Owed& owed) {
    if (!problem_.empty()) return;
    const FrameDump dump = to_dump(owed.view.get());
    try {
        write_files(owed, dump);
    } catch (const std::exception& error) {
        problem_ = fmt::format("pictures are missing from frame {} on: {}", owed.index, reason_of(error));
        folder_.discard_staged();
        dump_every_ = 0;
        preview_at_.clear();
    }
}

void FrameDumps::write_files(const Owed& owed, const FrameDump& dump) {
    if (owed.dump) {
        const std::string name = fmt::format("frames/{:06}.exr", owed.index);
        write_exr(folder_.stage(name), channels_of(dump), kRunIdPending);
        folder_.publish(name);
        dumped_.push_back(name);
    }
    if (owed.preview_input) {
        PreviewOptions options;
        options.title = fmt::format("frame {}", owed.index);
        std::string png = preview_png(*owed.preview_input, dump, options);
        folder_.write(fmt::format("previews/{:06}.png", owed.index), png);
        previews_.push_back({options.title, std::move(png)});
        pairs_.push_back(picture_pair(*owed.preview_input, dump, options.title));
    }
}

}  // namespace patina::tools
