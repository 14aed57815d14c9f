#include "tests/gpu/specular/fit_ward_rig.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace patina {

using reference::Ward;

namespace {

constexpr float kBlurM = 0.0076f;  // of a bent surface that an observation shows at once
constexpr glm::dvec3 kAmbient(0.05, 0.04, 0.03);

}  // namespace

const std::vector<Light> FitWardTest::kLights = {
    {{1.0f, -2.0f, 0.5f}, {3, 2.5f, 2}}, {{-1.5f, -1.8f, -1.0f}, {2, 2, 2.5f}}, {{0.2f, -2.2f, 1.5f}, {1, 1.5f, 1}}};

FitWardTest::FitWardTest() {
    graph::FrameGraph frame = runner().begin();
    voxel_map_.reset(frame, glm::dvec3(0));
    map_.reset(frame, glm::dvec3(0));
    samples_.reset(frame);
    estimates_.reset(frame);
    table_.reset(frame);
    run(std::move(frame));
    set_lights(kLights);
    materials_.resize(kLabels);
}

void FitWardTest::set_lights(const std::vector<Light>& lights) {
    lights_ = lights;
    rig_.lights.set(lights_, kAmbient);
}

std::vector<reference::ReceivedLight> FitWardTest::received() const {
    std::vector<reference::ReceivedLight> lights;
    for (const Light& light : lights_)
        lights.push_back({.position_m = light.position_m, .intensity = light.intensity, .axis = light.axis});
    return lights;
}

glm::dvec3 FitWardTest::direction_about(glm::dvec3 axis, double least_cosine) {
    std::normal_distribution<double> gauss;
    for (;;) {
        const glm::dvec3 d = glm::normalize(glm::dvec3(gauss(random_), gauss(random_), gauss(random_)));
        if (glm::dot(d, axis) > least_cosine) return d;
    }
}

std::vector<FilledRecord> FitWardTest::sphere(uint32_t label, const Ward& gloss, uint32_t voxels, float radius_m) {
    std::uniform_real_distribution<double> level(0.05, 0.5);
    std::vector<FilledRecord> records;
    while (records.size() < voxels) {
        const glm::vec3 normal(direction_about({0, -1, 0}, 0.2));
        const glm::ivec3 voxel(glm::floor(radius_m * normal / map_.settings().voxel_m));
        if (!used_.insert({voxel.x, voxel.y, voxel.z}).second) continue;
        FilledRecord record{radius_m * normal, normal, label, {}};
        const reference::SurfacePoint point{glm::dvec3(kept_point_m(map_, record)), glm::dvec3(normal)};
        const Ward material{{level(random_), level(random_), level(random_)}, gloss.ks, gloss.alpha};
        while (record.observations.size() < gpu::kMaxObservations) {
            const glm::dvec3 direction = direction_about(point.normal, 0.3);
            const glm::dvec3 rgb = reference::shade(material, point, received(), kAmbient, direction);
            record.observations.push_back({glm::vec3(direction), glm::vec3(rgb), {}});
        }
        records.push_back(record);
    }
    return records;
}

std::vector<FilledRecord> FitWardTest::clipped(std::vector<FilledRecord> records, float most) {
    for (FilledRecord& record : records) {
        for (FilledObservation& seen : record.observations) {
            for (glm::length_t c = 0; c < 3; ++c) {
                seen.clipped[static_cast<size_t>(c)] = seen.rgb[c] > most;
                seen.rgb[c] = std::min(seen.rgb[c], most);
            }
        }
    }
    return records;
}

void FitWardTest::fill(const std::vector<FilledRecord>& records) {
    std::vector<std::vector<uint32_t>> kept(kLabels);
    for (uint32_t i = 0; i < records.size(); ++i) kept[records[i].label].push_back(i);
    if (backwards_) std::ranges::for_each(kept, [](auto& of_label) { std::ranges::reverse(of_label); });
    ReflectanceSettings settings;
    settings.shadows = false;
    settings.first_marched_records = 1u << 20;
    rig_.update(settings, [&](graph::FrameGraph& frame, ObservationMapIds& ids) {
        add_fill_records(frame, map_, ids, records);
        add_keep_records(frame, samples_, kept);
        return add_list_records(frame, static_cast<uint32_t>(records.size()));
    });
}

void FitWardTest::shadow_all() {
    graph::FrameGraph frame = runner().begin();
    frame.keep(frame.fill(map_.import(frame).visibility, 0));
    run(std::move(frame));
}

void FitWardTest::set_mirror(uint32_t label, const gpu::MirrorFit& fit, float mirror) {
    graph::FrameGraph frame = runner().begin();
    frame.keep(frame.upload_bytes(table_.import(frame).mirrors, label * sizeof(fit), std::as_bytes(std::span(&fit, 1)),
                                  false));
    run(std::move(frame));
    rig_.set_mirror(label, mirror);
}

void FitWardTest::set_network(uint32_t label, glm::vec4 ks_alpha) {
    graph::FrameGraph frame = runner().begin();
    const gpu::WardMaterial said{glm::vec4(0.2f, 0.2f, 0.2f, 5), ks_alpha};
    frame.keep(frame.upload_bytes(estimates_.import(frame).materials, label * sizeof(said),
                                  std::as_bytes(std::span(&said, 1)), false));
    run(std::move(frame));
}

std::vector<gpu::WardFit> FitWardTest::fit(const std::vector<uint32_t>& labels, uint32_t times) {
    std::vector<gpu::WardFit> fits;
    for (uint32_t i = 0; i < times; ++i) {
        std::vector<uint32_t> list{static_cast<uint32_t>(labels.size())};
        list.insert(list.end(), labels.begin(), labels.end());
        graph::FrameGraph frame = runner().begin();
        const ObservationMapIds records = map_.import(frame);
        const FitWardInputs inputs{map_,
                                   records,
                                   rig_.state().import(frame).status,
                                   rig_.lights.upload(frame),
                                   rig_.lights.position_version(),
                                   samples_,
                                   samples_.import(frame),
                                   estimates_.import(frame).materials,
                                   kLabels};
        WardFitIds ids = table_.import(frame);
        graph::BufferId materials = rig_.materials.import(frame);
        add_fit_ward(frame, inputs, {frame.upload<uint32_t>("batch", list), list[0]}, table_, ids, materials);
        WardFits::keep(frame, ids);
        frame.keep(materials);
        const graph::Readback read = frame.read_back(ids.fits), read_materials = frame.read_back(materials);
        runner().submit(std::move(frame));
        runner().wait();
        fits = read.as<gpu::WardFit>();
        materials_ = read_materials.as<gpu::SegmentMaterial>();
    }
    return fits;
}

std::array<int, 3> FitWardTest::voxel_of(const FilledRecord& record) const {
    const glm::ivec3 voxel(glm::floor(record.point_m / map_.settings().voxel_m));
    return {voxel.x, voxel.y, voxel.z};
}

std::vector<double> FitWardTest::blur2_of(const std::vector<FilledRecord>& records) const {
    std::map<std::array<int, 3>, glm::dvec3> normals;
    for (const FilledRecord& record : records) normals[voxel_of(record)] = glm::dvec3(record.normal);
    std::vector<double> blur2;
    for (const FilledRecord& record : records) {
        double sum = 0;
        int count = 0;
        for (size_t axis = 0; axis < 3; ++axis) {
            for (const int step : {-1, 1}) {
                std::array<int, 3> beside = voxel_of(record);
                beside[axis] += step;
                const auto found = normals.find(beside);
                if (found == normals.end() || glm::dot(found->second, glm::dvec3(record.normal)) < 0.5) continue;
                sum += 2 - 2 * glm::dot(found->second, glm::dvec3(record.normal));
                ++count;
            }
        }
        blur2.push_back(count == 0 ? 0 : std::pow(std::min(kBlurM / map_.settings().voxel_m, 1.0f), 2) * sum / count);
    }
    return blur2;
}

std::vector<FitWardTest::ReferenceFit> FitWardTest::reference_fits(const std::vector<FilledRecord>& records,
                                                                   uint32_t times, const std::vector<double>& blur2,
                                                                   const reference::SpecularPrior& prior) const {
    std::vector<reference::FittedVoxel> voxels;
    for (const FilledRecord& record : records) {
        voxels.push_back({{glm::dvec3(kept_point_m(map_, record)), glm::dvec3(record.normal)}, {}, received()});
        if (!blur2.empty()) voxels.back().blur2 = blur2[voxels.size() - 1];
        for (const FilledObservation& seen : record.observations)
            voxels.back().observations.push_back({glm::dvec3(seen.to_viewer), glm::dvec3(seen.rgb), seen.clipped});
    }
    reference::WardFitSeries series(prior, kAmbient);
    std::vector<ReferenceFit> fits;
    for (uint32_t i = 0; i < times; ++i) {
        const Ward material = series.fit(voxels);
        fits.push_back({material, series.confidence(), series.kd()});
    }
    return fits;
}

void FitWardTest::expect_agreement(const gpu::WardFit& got, const ReferenceFit& want, double ks, double alpha,
                                   double confidence) {
    EXPECT_LT(max_of(glm::abs(glm::dvec3(got.ks_alpha) - want.material.ks)), ks);
    EXPECT_NEAR(got.ks_alpha.w, want.material.alpha, alpha);
    EXPECT_NEAR(got.confidence, want.confidence, confidence);
    EXPECT_LT(max_of(glm::abs(glm::dvec3(kd_of(got).value()) - want.kd)), ks);
}

}  // namespace patina
