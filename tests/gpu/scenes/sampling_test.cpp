#include "tests/reference/scenes/sampling.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "shared/test/test_sampling.h"
#include "spirv/shaders.h"
#include "tests/gpu/gpu_test.h"

namespace patina::sampling_test {
namespace {

using gpu::SamplingAnswer;
using gpu::SamplingQuery;
using std::numbers::pi;

constexpr double kAlphas[] = {0.05, 0.15, 0.4, 1.0};

class SamplingTest : public GpuTest {
  protected:
    std::vector<SamplingAnswer> ask(const std::vector<SamplingQuery>& queries) {
        graph::FrameGraph frame = runner().begin();
        const auto in = frame.upload<SamplingQuery>("queries", queries);
        auto pass = frame.compute("test.sampling", spirv::test_sampling);
        pass.read("Queries", in).push(gpu::SamplingParams{static_cast<uint32_t>(queries.size())});
        const auto out = pass.create("Answers", queries.size() * sizeof(SamplingAnswer));
        pass.dispatch_covering(static_cast<uint32_t>(queries.size()));
        const graph::Readback answers = frame.read_back(out, 0, queries.size() * sizeof(SamplingAnswer));
        run(std::move(frame));
        return answers.as<SamplingAnswer>();
    }
};

/// Numbers in [0, 1) that both sides take for the same: multiples of 2^-24.
class Numbers {
  public:
    explicit Numbers(uint32_t seed) : random_(seed) {}
    float next() { return static_cast<float>(random_() >> 8) / 16777216.0f; }
    glm::vec2 pair() {
        const float x = next();
        return {x, next()};
    }
    glm::dvec3 above(glm::dvec3 normal) {
        glm::dvec3 d(0);
        do {
            d = {2 * next() - 1.0, 2 * next() - 1.0, 2 * next() - 1.0};
        } while (glm::length(d) > 1 || glm::length(d) < 1e-3 || glm::dot(d, normal) < 1e-3);
        return glm::normalize(d);
    }
    glm::dvec3 anywhere() {
        const glm::dvec3 d = above({0, 0, 1});
        return next() < 0.5f ? d : -d;
    }

  private:
    std::mt19937 random_;
};

SamplingQuery query(double alpha, glm::dvec3 normal, glm::dvec3 to_viewer, glm::vec2 u, float cap_height = 1) {
    SamplingQuery q{};
    q.u = glm::vec4(u, cap_height, 0);
    q.normal = glm::vec4(normal, alpha);
    q.to_viewer = q.to_light = glm::vec4(to_viewer, 0);
    q.ks = glm::vec4(1);
    return q;
}

/// Queries for the numbers of a stream, everything else being of no interest.
SamplingQuery numbers_query(uint64_t seed, uint32_t frame, uint32_t pixel, uint32_t index, uint32_t dimension) {
    SamplingQuery q = query(1, {0, 0, 1}, {0, 0, 1}, {0, 0});
    q.seed_frame_pixel = {static_cast<uint32_t>(seed), static_cast<uint32_t>(seed >> 32), frame, pixel};
    q.index_dimension = {index, dimension, 0, 0};
    return q;
}

double unit_interval(uint32_t word) { return word / 4294967296.0; }

TEST_F(SamplingTest, RandomNumbersAreTheHashOfWhatTheyAreFor) {
    std::vector<SamplingQuery> queries;
    std::mt19937 random(3);
    for (int i = 0; i < 500; ++i) {
        const uint64_t seed = uint64_t{random()} << 32 | random();
        queries.push_back(numbers_query(seed, random(), random(), random() % 1000, random() % 1000));
    }
    const auto answers = ask(queries);
    for (size_t i = 0; i < queries.size(); ++i) {
        const auto& s = queries[i].seed_frame_pixel;
        const auto& id = queries[i].index_dimension;
        const auto stream = reference::hash_words({s.x, s.y, s.z, s.w});
        EXPECT_EQ(answers[i].words, glm::uvec4(stream[0], stream[1], 0, 0));
        const auto words = reference::hash_words({stream[0], stream[1], id.x, id.y});
        const auto shift = reference::hash_words({stream[0], stream[1], UINT32_MAX, id.y});
        const glm::dvec2 r2 = reference::r2_point({unit_interval(shift[0]), unit_interval(shift[1])}, id.x);
        for (int c = 0; c < 4; ++c) EXPECT_NEAR(answers[i].random[c], unit_interval(words[c]), 0x1p-24);
        for (int c = 2; c < 4; ++c) EXPECT_EQ(answers[i].stratified[c], answers[i].random[c]);
        for (int c = 0; c < 2; ++c) {
            // The steps are whole multiples of 2^-32; on the circle, 0 lies next to 1.
            const double off = std::abs(answers[i].stratified[c] - r2[c]);
            EXPECT_LT(std::min(off, 1 - off), 0x1p-24 + 1000 * 0x1p-33);
        }
    }
}

/// Pearson's statistic less its expectation, in its standard deviations, of counts that should be equal.
double excess_chi_square(const std::vector<int>& counts) {
    double total = 0, sum = 0;
    for (const int count : counts) total += count;
    const double expected = total / static_cast<double>(counts.size());
    for (const int count : counts) sum += (count - expected) * (count - expected) / expected;
    const auto freedom = static_cast<double>(counts.size() - 1);
    return (sum - freedom) / std::sqrt(2 * freedom);
}

// Neighbouring pixels, samples, dimensions, frames and seeds: all that a picture's numbers differ in.
TEST_F(SamplingTest, RandomNumbersAreUniformAndIndependentOfTheirNeighbours) {
    constexpr uint32_t kCount = 32 * 32 * 16;
    for (int varied = 0; varied < 5; ++varied) {
        std::vector<SamplingQuery> queries;
        for (uint32_t i = 0; i < kCount; ++i) {
            uint32_t v[5] = {7, 7, 7, 7, 7};
            v[varied] = i;
            queries.push_back(numbers_query(v[0], v[1], v[2], v[3], v[4]));
        }
        const auto answers = ask(queries);
        std::vector<int> within(32 * 32), beside(32 * 32);
        for (uint32_t i = 0; i < kCount; ++i) {
            const glm::uvec4 cell(answers[i].random * 32.0f);
            const glm::uvec4 next(answers[(i + 1) % kCount].random * 32.0f);
            ++within[cell.x * 32 + cell.y];
            ++beside[cell.x * 32 + next.x];
        }
        EXPECT_LT(std::abs(excess_chi_square(within)), 4) << varied;
        EXPECT_LT(std::abs(excess_chi_square(beside)), 4) << varied;
    }
}

// 256 random points put 16 +- 4 into a strip of a sixteenth, and leave a 1/e of the cells of a 16 x 16 grid empty.
TEST_F(SamplingTest, StratifiedNumbersFillTheSquareEvenly) {
    for (uint32_t pixel = 0; pixel < 20; ++pixel) {
        std::vector<SamplingQuery> queries;
        for (uint32_t i = 0; i < 256; ++i) queries.push_back(numbers_query(1, 0, pixel, i, 3));
        std::vector<int> columns(16), rows(16), cells(256);
        for (const SamplingAnswer& a : ask(queries)) {
            const glm::uvec4 cell(a.stratified * 16.0f);
            ++columns[cell.x], ++rows[cell.y], ++cells[16 * cell.y + cell.x];
        }
        for (int i = 0; i < 16; ++i) {
            EXPECT_NEAR(columns[i], 16, 2);
            EXPECT_NEAR(rows[i], 16, 2);
        }
        EXPECT_LT(std::count(cells.begin(), cells.end(), 0), 60);
    }
}

TEST_F(SamplingTest, DirectionsMatchTheirFormulas) {
    Numbers numbers(5);
    std::vector<SamplingQuery> queries;
    for (int i = 0; i < 2000; ++i) {
        const glm::dvec3 normal = i == 0 ? glm::dvec3(0, 0, -1) : numbers.anywhere();
        const float height = std::pow(10.0f, -6 * numbers.next());
        queries.push_back(query(kAlphas[i % 4], normal, numbers.above(normal), numbers.pair(), height));
    }
    const auto answers = ask(queries);
    for (size_t i = 0; i < queries.size(); ++i) {
        const SamplingQuery& q = queries[i];
        const SamplingAnswer& a = answers[i];
        const glm::dmat3 basis(glm::dvec3(a.tangent), glm::dvec3(a.bitangent), glm::dvec3(q.normal));
        const glm::dmat3 product = glm::transpose(basis) * basis;
        for (int c = 0; c < 9; ++c) EXPECT_NEAR(product[c / 3][c % 3], c % 4 == 0 ? 1 : 0, 1e-6);
        EXPECT_NEAR(glm::determinant(basis), 1, 1e-6);

        const glm::dvec2 u(q.u);
        EXPECT_LT(glm::distance(glm::dvec3(a.cosine), reference::direction(std::asin(std::sqrt(u.x)), 2 * pi * u.y)),
                  1e-6);
        const double theta = 2 * std::asin(std::sqrt(u.x * q.u.z / 2));  // 1 - cos(theta) = 2 sin^2(theta / 2)
        const glm::dvec3 cap = reference::direction(theta, 2 * pi * u.y);
        EXPECT_LT(glm::distance(glm::dvec3(a.cap), cap), 2e-7 + 1e-6 * std::sin(theta));

        const glm::dvec3 half_vector = basis * reference::sampled_half_vector(q.normal.w, u);
        const glm::dvec3 mirrored = -glm::reflect(glm::dvec3(q.to_viewer), half_vector);
        EXPECT_LT(glm::distance(glm::dvec3(a.ward), mirrored), 4e-6);
    }
}

/// Pairs of directions above the horizon: half of them anywhere, half of them near the mirror direction, where small
/// alphas have their lobe.
std::vector<SamplingQuery> brdf_queries(int count) {
    Numbers numbers(7);
    std::vector<SamplingQuery> queries;
    while (queries.size() < static_cast<size_t>(count)) {
        const double alpha = kAlphas[queries.size() % 4];
        const glm::dvec3 normal = numbers.anywhere(), to_viewer = numbers.above(normal);
        SamplingQuery q = query(alpha, normal, to_viewer, {0, 0});
        const glm::dvec3 near = -glm::reflect(to_viewer, glm::normalize(normal + alpha * numbers.anywhere()));
        const glm::dvec3 to_light = queries.size() % 8 < 4 ? near : numbers.above(normal);
        if (glm::dot(to_light, normal) < 1e-3) continue;
        q.to_light = glm::vec4(to_light, 0);
        q.kd = glm::vec4(0.1, 0.2, 0.0, 0);
        q.ks = glm::vec4(0.2, 0.1, 0.3, 0);
        queries.push_back(q);
    }
    return queries;
}

/// What fp32 makes of the exponent of a lobe: values below e^-40 of the peak are as good as 0.
double tolerance(double value, double peak) { return 1e-4 * value + 1e-17 * peak; }

glm::dvec3 unit(glm::vec4 v) { return glm::normalize(glm::dvec3(v)); }

TEST_F(SamplingTest, WardValuesAndDensitiesMatchTheDoubleReference) {
    const auto queries = brdf_queries(8000);
    const auto answers = ask(queries);
    double worst = 0;
    for (size_t i = 0; i < queries.size(); ++i) {
        const SamplingQuery& q = queries[i];
        const double alpha = q.normal.w;
        const reference::Ward material{glm::dvec3(q.kd), glm::dvec3(q.ks), alpha};
        const auto expected = reference::ward(material, unit(q.normal), unit(q.to_light), unit(q.to_viewer));
        const double peak = 1 / (4 * pi * alpha * alpha);
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(answers[i].brdf[c], expected[c], tolerance(expected[c], peak)) << i;
            if (expected[c] > 1e-9 * peak) worst = std::max(worst, std::abs(answers[i].brdf[c] / expected[c] - 1));
        }
        const double density = reference::ward_density(alpha, unit(q.normal), unit(q.to_light), unit(q.to_viewer));
        EXPECT_NEAR(answers[i].brdf.w, density, tolerance(density, peak)) << i;
    }
    RecordProperty("worst_relative_error", testing::PrintToString(worst));
    EXPECT_LT(worst, 1e-4);
}

TEST_F(SamplingTest, WardIsReciprocal) {
    const auto queries = brdf_queries(4000);
    for (const SamplingAnswer& a : ask(queries))
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(a.brdf[c], a.reversed[c], 1e-5 * a.brdf[c]);
}

/// The Ward lobe's queries of one alpha and viewer in a fixed frame, with the points of a jittered grid of n x n cells.
std::vector<SamplingQuery> lobe_queries(double alpha, double theta_viewer, int n, uint32_t seed) {
    Numbers numbers(seed);
    std::vector<SamplingQuery> queries;
    for (int i = 0; i < n * n; ++i) {
        const glm::vec2 cell(static_cast<float>(i % n), static_cast<float>(i / n));
        const glm::vec2 u = glm::min((cell + numbers.pair()) / static_cast<float>(n), glm::vec2(1 - 0x1p-24f));
        queries.push_back(query(alpha, {0, 0, 1}, reference::direction(theta_viewer, 0), u));
    }
    return queries;
}

// The samples' average weight is the albedo that quadrature finds; near normal incidence and for small alpha, ks.
TEST_F(SamplingTest, AverageWeightOfWardSamplesIsTheAlbedo) {
    constexpr int kSide = 128;
    for (const double alpha : {0.1, 0.2, 0.4, 1.0}) {
        for (const double degrees : {0.0, 30.0, 60.0, 75.0}) {
            const double theta = degrees * pi / 180;
            double sum = 0, sum2 = 0;
            for (const SamplingAnswer& a : ask(lobe_queries(alpha, theta, kSide, 11))) {
                sum += a.weight.g;
                sum2 += a.weight.g * a.weight.g;
            }
            const double n = kSide * kSide, mean = sum / n;
            // Without the grid's help, which makes it smaller.
            const double sigma = std::sqrt((sum2 / n - mean * mean) / n);
            const double expected = reference::ward_albedo({glm::dvec3(0), glm::dvec3(1), alpha}, theta, 600, 180).g;
            EXPECT_NEAR(mean, expected, 4 * sigma + 1e-3 * expected) << alpha << ' ' << degrees;
            EXPECT_LT(sigma, 0.015 * expected) << alpha << ' ' << degrees;
            if (degrees == 0) {
                EXPECT_NEAR(mean, 1, 3 * alpha * alpha);
            }
        }
    }
}

/// Expected counts of directions over the cells of the hemisphere, by quadrature of the density.
std::vector<double> expected_counts(double alpha, double theta_viewer, int rows, int columns, double total) {
    constexpr int kSteps = 24;
    std::vector<double> counts(static_cast<size_t>(rows * columns));
    const double theta_step = pi / 2 / (rows * kSteps), phi_step = 2 * pi / (columns * kSteps);
    for (int i = 0; i < rows * kSteps; ++i) {
        for (int j = 0; j < columns * kSteps; ++j) {
            const double theta = (i + 0.5) * theta_step;
            const double density =
                reference::ward_density(alpha, {0, 0, 1}, reference::direction(theta, (j + 0.5) * phi_step),
                                        reference::direction(theta_viewer, 0));
            counts[(i / kSteps) * columns + j / kSteps] += total * density * std::sin(theta) * theta_step * phi_step;
        }
    }
    return counts;
}

TEST_F(SamplingTest, WardSamplesFollowTheirDensity) {
    constexpr int kRows = 18, kColumns = 24, kSide = 160;
    for (const auto& [alpha, theta_viewer] : {std::pair(0.15, 0.6), std::pair(0.4, 1.2), std::pair(1.0, 0.3)}) {
        std::vector<double> counts(kRows * kColumns);
        double below = 0;
        std::vector<SamplingQuery> queries = lobe_queries(alpha, theta_viewer, kSide, 13);
        Numbers numbers(17);  // independent points: those of a grid would make the statistic too small
        for (SamplingQuery& q : queries) q.u = glm::vec4(numbers.pair(), 1, 0);
        for (const SamplingAnswer& a : ask(queries)) {
            if (a.ward.z <= 0) {
                ++below;
                continue;
            }
            const double theta = std::acos(std::min(1.0f, a.ward.z)), phi = std::atan2(a.ward.y, a.ward.x);
            const int row = std::min(kRows - 1, static_cast<int>(theta / (pi / 2) * kRows));
            const int column = std::min(kColumns - 1, static_cast<int>((phi / (2 * pi) + (phi < 0)) * kColumns));
            ++counts[static_cast<size_t>(row * kColumns + column)];
        }
        const double total = kSide * kSide;
        const auto expected = expected_counts(alpha, theta_viewer, kRows, kColumns, total);
        double above = 0, chi2 = 0, rare = 0, rare_expected = 0;
        int cells = 0;
        for (size_t i = 0; i < expected.size(); ++i) {
            above += expected[i];
            if (expected[i] < 8) {
                rare += counts[i], rare_expected += expected[i];
                continue;
            }
            ++cells;
            chi2 += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i];
        }
        EXPECT_LE(above, 1.0001 * total) << "a density integrates to at most 1";
        EXPECT_NEAR(below, total - above, 4 * std::sqrt(total - above) + 1e-3 * total);
        EXPECT_NEAR(rare, rare_expected, 4 * std::sqrt(rare_expected) + 1);
        EXPECT_LT((chi2 - cells) / std::sqrt(2.0 * cells), 4) << alpha << ", " << cells << " cells";
    }
}

}  // namespace
}  // namespace patina::sampling_test
