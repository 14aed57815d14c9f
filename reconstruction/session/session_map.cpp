// How a session's state goes into its map, and comes back.

#include <algorithm>

#include <fmt/format.h>

#include "reconstruction/session/choices.h"
#include "reconstruction/session/session_core.h"
#include "reconstruction/session/session_state.h"
#include "scenes/render/synthetic_source.h"

namespace patina {

namespace {

/// How far a session is, for people and for open_map().
nlohmann::ordered_json progress_json(const sensor::Ledger& ledger, const SequenceInfo& info, bool ended) {
    nlohmann::ordered_json json{{"read", ledger.read()}, {"used", ledger.used()}, {"ended", ended}};
    if (info.frames) json["frames"] = *info.frames;
    return json;
}

/// Names of files need not be UTF-8.
std::string text_of(const nlohmann::ordered_json& json) {
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

/// How many of a session's frames were in a model.
struct FramesInModel {
    uint32_t used = 0, held_out = 0;
};

constexpr const char* kFramesInModel = "session.frames_in_model";
constexpr const char* kWorldOffset = "session.world_offset_m";

}  // namespace

glm::dvec3 world_offset_in(vulkan::Device& device, MapFile& map) {
    glm::dvec3 offset_m{0};
    StateReader reader(device, map);
    reader.value(kWorldOffset, offset_m);
    return offset_m;
}

SessionLight light_in(vulkan::Device& device, MapFile& map) {
    SessionLight light;
    StateReader reader(device, map);
    visit(reader, light);
    return light;
}

void SessionCore::open_map() {
    if (options_.resume) {
        map_ = MapFile::with_state(options_.map);
        return;
    }
    std::error_code failure;
    if (!std::filesystem::exists(options_.map, failure)) return;
    map_ = std::make_unique<MapFile>(options_.map);
    if (!map_->has_state()) return;
    const auto progress = map_->expect_json("progress");
    if (progress.value("ended", false)) return;
    throw Error(
        hinted(patina::text("'", options_.map.string(), "' holds a session that has not come to its end, after ",
                            progress.value("read", 0), " frames; go on with it, or remove the file"),
               options_.hints.resume));
}

std::shared_ptr<MapFile> SessionCore::earlier_map() const {
    if (options_.resume) return map_;
    if (!options_.extends.empty()) return MapFile::with_state(options_.extends);
    return nullptr;
}

void SessionCore::visit(graph::StateVisitor& visitor) {
    pipeline_->visit(visitor);
    patina::visit(visitor, ledger_, {used_, held_out_indices_, repeated_, undone_indices_});
    patina::visit(visitor, tracked_);
    visitor.values("session.poses", poses_);
    visitor.value("session.first_given", first_given_);
}

void SessionCore::extend(MapFile& earlier) {
    expect_same(options_.extends, model_of(earlier.expect_json("session")),
                model_of(identity_of(options_, info_, settings())));
    StateReader reader(device_, earlier);
    pipeline_->visit(reader);
    reader.finish();
    pipeline_->begin_recording();
    report(options_.callbacks,
           fmt::format("extends the map of {} frames in '{}'", pipeline_->frames(), options_.extends.string()));
}

void SessionCore::resume() {
    expect_same(options_.map, map_->expect_json("session"), identity_of(options_, info_, settings()));
    StateReader reader(device_, *map_);
    visit(reader);
    reader.finish();
    kept_after_ = ledger_.read();
    skip_readings();
    report(options_.callbacks,
           fmt::format("goes on after {} frames, from '{}'", ledger_.read(), options_.map.string()));
}

/// Of a recording they are read again, as it is inspected frame by frame.
void SessionCore::skip_readings() {
    if (scene_) return scene_->skip_to(ledger_.read());
    for (uint32_t index = 0; index < ledger_.read(); ++index) {
        stop_if_interrupted();
        const std::optional<Reading> reading = source_->next();
        if (!reading)
            throw Error("'", options_.map.string(), "' goes on after frame ", ledger_.read(), ", but '", info_.name,
                        "' ends after frame ", index);
        if (inspector_) inspector_->add(*reading);
        const auto* frame = std::get_if<Frame>(&*reading);
        if (frame && !std::binary_search(repeated_.begin(), repeated_.end(), index)) see_brightness(*frame);
    }
}

void SessionCore::checkpoint(const MoreState& more) {
    if (options_.map.empty()) throw Error("a checkpoint was asked for, but no file to write it to");
    pipeline_->wait();
    if (!map_) {
        if (options_.map.has_parent_path()) std::filesystem::create_directories(options_.map.parent_path());
        std::error_code failure;
        made_map_ = !std::filesystem::exists(options_.map, failure);
        map_ = std::make_unique<MapFile>(options_.map);
    }
    Transaction change(map_->database());
    if (!kept_after_) map_->clear();
    const vulkan::DeviceCaps& caps = device_.caps();
    map_->set_text("device", fmt::format("{}, {}", caps.name, caps.driver));
    map_->set_text("session", text_of(identity_of(options_, info_, settings())));
    map_->set_text("detail", text_of(detail_json(detail_)));
    map_->set_text("lights", text_of(lights_json(illumination_)));
    map_->set_text("progress", text_of(progress_json(ledger_, info_, ended_)));
    SessionLight light{illumination_, no_light_because_, shortfalls_};
    StateWriter writer(device_, *map_);
    patina::visit(writer, light);
    writer.value(kWorldOffset, world_offset_m_);
    visit(writer);
    if (more) more(writer, *map_);
    writer.finish();
    change.commit();
    kept_after_ = ledger_.read();
}

/// Where nothing could be kept, no file is left that was not there.
void SessionCore::forget_empty_map() {
    if (!made_map_ || kept_after_) return;
    map_.reset();
    std::error_code failure;
    std::filesystem::remove(options_.map, failure);
}

void SessionCore::mark_ended() {
    Transaction change(map_->database());
    map_->set_text("progress", text_of(progress_json(ledger_, info_, ended_)));
    change.commit();
}

void SessionCore::checkpoint_if_due(const MoreState& more) {
    if (options_.map.empty() || options_.checkpoint_every == 0 || ledger_.used() == 0) return;
    if (!ended_ && ledger_.read() % options_.checkpoint_every != 0) return;
    try {
        if (ended_ && kept_after_ == ledger_.read()) {
            mark_ended();
        } else {
            checkpoint(more);
        }
        checkpoint_problem_.clear();
    } catch (const std::exception& error) {
        forget_empty_map();
        checkpoint_problem_ =
            fmt::format("the state after {} frames could not be kept: {}", ledger_.read(), reason_of(error));
        report(options_.callbacks, "warning: " + checkpoint_problem_);
    }
}

void SessionCore::keep_model(MapFile& map) {
    Transaction change(map.database());
    StateWriter writer(device_, map);
    pipeline_->visit(writer);
    SessionLight light{illumination_, no_light_because_, shortfalls_};
    patina::visit(writer, light);
    FramesInModel frames{static_cast<uint32_t>(used_.size()), static_cast<uint32_t>(held_out_indices_.size())};
    writer.value(kFramesInModel, frames);
    writer.finish();
    change.commit();
}

void SessionCore::go_back(MapFile& map) {
    map.check();  // what is half brought back is of no use
    StateReader reader(device_, map);
    FramesInModel frames;
    reader.value(kFramesInModel, frames);
    pipeline_->visit(reader);
    SessionLight light;
    patina::visit(reader, light);
    reader.finish();
    illumination_ = std::move(light.illumination);  // as the pipeline's
    if (pipeline_->keyframes()) pipeline_->begin_recording();
    for (auto [indices, count] : {std::pair(&used_, frames.used), {&held_out_indices_, frames.held_out}}) {
        const auto first = indices->begin() + count;
        ledger_.undo(static_cast<uint32_t>(indices->end() - first));
        undone_indices_.insert(undone_indices_.end(), first, indices->end());
        indices->erase(first, indices->end());
    }
    poses_.resize(used_.size());
    fused_.reset();
    held_out_.reset();
}

void SessionCore::bring_back(const MoreState& more) {
    if (!options_.resume) return;
    StateReader reader(device_, *map_);
    more(reader, *map_);
    reader.finish();
}

}  // namespace patina
