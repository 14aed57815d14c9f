#pragma once

#include <algorithm>
#include <array>
#include <random>
#include <set>
#include <vector>

#include "passes/specular/fit_ward.h"
#include "shared/reflectance/reflectance.h"
#include "shared/specular/mirror_fit.h"
#include "tests/gpu/gpu_test.h"
#include "tests/gpu/reflectance/reflectance_rig.h"
#include "tests/reference/specular/fit_ward.h"
#include "tools/bench/filled_records.h"

namespace patina {

/// Segments made up from known materials and lights, to be fitted.
class FitWardTest : public GpuTest {
  protected:
    static constexpr uint32_t kLabels = 16;
    static constexpr uint32_t kVoxels = 128;  ///< of a segment
    static const std::vector<Light> kLights;

    FitWardTest();

    /// In place of kLights.
    void set_lights(const std::vector<Light>& lights);

    std::vector<reference::ReceivedLight> received() const;

    glm::dvec3 direction_about(glm::dvec3 axis, double least_cosine);

    /// Voxels of a sphere about the origin, each with a kd of its own and seen from random directions.
    std::vector<FilledRecord> sphere(uint32_t label, const reference::Ward& gloss, uint32_t voxels = kVoxels,
                                     float radius_m = 0.4f);

    /// As a camera records them whose channels end at `most`.
    static std::vector<FilledRecord> clipped(std::vector<FilledRecord> records, float most);

    /// Puts voxels into the map; each label keeps its own, in the order of `kept`.
    void fill(const std::vector<FilledRecord>& records);

    /// What no light reaches.
    void shadow_all();

    /// What mirrored surroundings are taken to have told of a label, and how sure it is to be a mirror.
    void set_mirror(uint32_t label, const gpu::MirrorFit& fit, float mirror);

    /// What the network is taken to have said.
    void set_network(uint32_t label, glm::vec4 ks_alpha);

    /// Fits the segments so many times; by label.
    std::vector<gpu::WardFit> fit(const std::vector<uint32_t>& labels, uint32_t times = 1);

    std::array<int, 3> voxel_of(const FilledRecord& record) const;

    /// FittedVoxel::blur2 of each record, from the records of the same face whose voxels touch.
    std::vector<double> blur2_of(const std::vector<FilledRecord>& records) const;

    /// What the reference finds.
    struct ReferenceFit {
        reference::Ward material;
        double confidence = 0;
        glm::dvec3 kd{0};  ///< of all voxels together
    };
    /// With each of so many fits.
    std::vector<ReferenceFit> reference_fits(const std::vector<FilledRecord>& records, uint32_t times = 1,
                                             const std::vector<double>& blur2 = {},
                                             const reference::SpecularPrior& prior = {}) const;
    /// Within the largest difference of ks, of alpha, and of the confidence.
    static void expect_agreement(const gpu::WardFit& got, const ReferenceFit& want, double ks, double alpha,
                                 double confidence);

    std::vector<Light> lights_;
    std::mt19937 random_{1};
    std::set<std::array<int, 3>> used_;  // a voxel has one record
    bool backwards_ = false;
    VoxelMap voxel_map_{device(), {.capacity_blocks = 64}};
    // Two chunks of 512 records.
    ObservationMap map_{device(),
                        {.capacity_blocks = 256, .capacity_records = 1024, .max_chunk_bytes = uint64_t{1} << 16}};
    ReflectanceRig rig_{device(), runner(), voxel_map_, map_};
    SegmentSamples samples_{device(), kLabels};
    SpecularEstimates estimates_{device(), kLabels};
    WardFits table_{device(), kLabels};
    std::vector<gpu::SegmentMaterial> materials_;
};

inline double max_of(glm::dvec3 v) { return std::max({v.x, v.y, v.z}); }

}  // namespace patina
