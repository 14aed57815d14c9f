#include "export/gltf_material.h"

#include <gtest/gtest.h>

namespace patina::gltf_material_test {
namespace {

constexpr glm::vec3 kGrey(0.5f);
constexpr float kAlphas[] = {0.005f, 0.05f, 0.2f, 0.5f, 1.0f};
constexpr glm::vec3 kColors[] = {{1, 1, 1}, {1, 0.6f, 0.1f}, {0.2f, 1, 0.7f}};
constexpr glm::vec3 kAlbedos[] = {{0.6f, 0.3f, 0.1f}, {0.01f, 0.01f, 0.01f}, {0.95f, 0.95f, 0.9f}, {0, 0, 0}};

void expect_close(glm::vec3 got, glm::vec3 expected, float relative) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], expected[c], relative * expected[c] + 1e-7f) << c;
}

/// Calls use(gloss, kd) for ks from 0 to 1 in steps of 1/64, in three colours, for each alpha and kd.
template <class Use>
void sweep(Use use) {
    for (const float alpha : kAlphas) {
        for (const glm::vec3 color : kColors) {
            for (const glm::vec3 kd : kAlbedos) {
                for (int step = 0; step <= 64; ++step) use({color * (static_cast<float>(step) / 64), alpha}, kd);
            }
        }
    }
}

TEST(GltfMaterial, ConvertsBackToKdKsAndAlpha) {
    int clamped = 0, metals = 0, all = 0;
    sweep([&](const WardGloss& gloss, glm::vec3 kd) {
        const GltfMaterial material = gltf_material(gloss, kd);
        const WardGloss back = ward_of(material);
        ++all;
        metals += material.metal;
        if (material.observed) {
            EXPECT_NEAR(back.alpha, gloss.alpha, 1e-4f * gloss.alpha);
        }
        if (!material.metal) expect_close(kd_of(material, base_color_of(material, kd)), kd, 1e-4f);
        const bool too_strong = !material.metal && gloss.ks.r > 0.68f;
        clamped += too_strong;
        if (!too_strong && material.observed && std::max(gloss.ks.r, gloss.ks.g) * 0.868f < 0.6f)
            expect_close(back.ks, gloss.ks, 2e-4f);
    });
    EXPECT_GT(metals, all / 10);
    EXPECT_LT(clamped, all / 4);
}

TEST(GltfMaterial, EveryFactorIsWithin0To1) {
    sweep([](WardGloss gloss, glm::vec3 kd) {
        for (const float confidence : {0.0f, 0.49f, 0.5f, 1.0f}) {
            gloss.confidence = confidence;
            const GltfMaterial material = gltf_material(gloss, kd);
            EXPECT_TRUE(material.roughness >= 0.045f && material.roughness <= 1);
            EXPECT_TRUE(material.specular >= 0 && material.specular <= 1) << material.specular;
            EXPECT_TRUE(material.ior >= 1 && material.ior < 8) << material.ior;
            for (int c = 0; c < 3; ++c) {
                EXPECT_TRUE(material.specular_color[c] >= 0 && material.specular_color[c] <= 1);
                EXPECT_TRUE(material.base_color[c] >= 0 && material.base_color[c] <= 1);
            }
        }
    });
}

TEST(GltfMaterial, TheIndexOfRefractionHasTheStrength) {
    const auto material_of_f0 = [](float f0) {
        return gltf_material({glm::vec3(f0 / (0.868f - 0.088f)), 0.4f}, kGrey);
    };
    EXPECT_NEAR(material_of_f0(0.04f).ior, 1.5f, 1e-5f);
    EXPECT_NEAR(material_of_f0(0.17f).ior, 2.4f, 0.01f);
    EXPECT_EQ(material_of_f0(0.17f).specular, 1);
    const GltfMaterial tinted = gltf_material({{0.1f, 0.05f, 0}, 0.4f}, kGrey);
    expect_close(f0_of(tinted), {0.078f, 0.039f, 0}, 1e-5f);
    expect_close(tinted.specular_color, {1, 0.5f, 0}, 1e-5f);
    EXPECT_NEAR(tinted.roughness * tinted.roughness, 0.4f, 1e-6f);
    expect_close(base_color_of(tinted, kGrey), kGrey / 0.922f, 1e-5f);
}

TEST(GltfMaterial, WhatIsNotObservedIsColourlessAndShinesNoMoreThanGlass) {
    for (const WardGloss& gloss :
         {WardGloss{glm::vec3(0.002f), 0.2f}, WardGloss{glm::vec3(0.3f, 0.2f, 0.1f), 0.2f, 0.2f},
          WardGloss{glm::vec3(0.03f), 0.2f, 0.0f}}) {
        const GltfMaterial material = gltf_material(gloss, kGrey);
        EXPECT_FALSE(material.observed);
        EXPECT_FALSE(needs_specular(material));
        EXPECT_EQ(material.specular_color, glm::vec3(1));
        EXPECT_NEAR(f0_of(material).r, std::min(gloss.ks.r * 0.824f, 0.04f), 1e-5f);
        EXPECT_NEAR(material.roughness, gloss.ks.r < 0.0024f ? 1 : std::sqrt(gloss.alpha), 1e-6f);
    }
    EXPECT_TRUE(gltf_material({glm::vec3(0.003f), 0.2f, 0.5f}, kGrey).observed);
    EXPECT_TRUE(needs_specular(gltf_material({glm::vec3(0.003f), 0.2f, 0.5f}, kGrey)));
}

TEST(GltfMaterial, WithConstantFresnelTheColourHasTheStrength) {
    // F0 = min(0.04 colour, 1) factor, and the lobe of ks 0.1 at alpha 0.4 has 0.1 (0.868 - 0.22 0.4).
    const GltfMaterial material = gltf_material({{0.1f, 0.05f, 0}, 0.4f}, kGrey, GltfFresnel::kConstant);
    expect_close(0.04f * material.specular_color * material.specular, {0.078f, 0.039f, 0}, 1e-5f);
    EXPECT_NEAR(material.specular, 0.078f, 1e-6f) << "F90 is the strongest channel's F0: it does not change with angle";
    EXPECT_EQ(material.ior, 1.5f);
    expect_close(base_color_of(material, kGrey), kGrey / 0.922f, 1e-5f);
    sweep([](const WardGloss& gloss, glm::vec3 kd) {
        const GltfMaterial constant = gltf_material(gloss, kd, GltfFresnel::kConstant);
        if (constant.specular > 0) expect_close(ward_of(constant).ks, gloss.ks, 1e-4f);
    });
}

TEST(GltfMaterial, WithoutKsIsDiffuseAlone) {
    for (const GltfFresnel fresnel : {GltfFresnel::kIor, GltfFresnel::kConstant}) {
        const GltfMaterial material = gltf_material({glm::vec3(0), 0.2f}, kGrey, fresnel);
        EXPECT_EQ(f0_of(material), glm::vec3(0));
        EXPECT_EQ(material.roughness == 1, fresnel == GltfFresnel::kIor) << "there its lobe is left at grazing angles";
        EXPECT_FALSE(material.metal || material.observed);
        EXPECT_EQ(base_color_of(material, kGrey), kGrey);
    }
}

TEST(GltfMaterial, IsAMetalWhereItIsBrightAndNotDiffuse) {
    EXPECT_TRUE(gltf_material({glm::vec3(0.5f), 0.2f}, glm::vec3(0.01f)).metal);
    EXPECT_FALSE(gltf_material({glm::vec3(0.5f), 0.2f}, glm::vec3(0.1f)).metal);
    EXPECT_FALSE(gltf_material({glm::vec3(0.2f), 0.2f}, glm::vec3(0.01f)).metal);
    EXPECT_FALSE(gltf_material({glm::vec3(0.5f), 0.2f, 0.1f}, glm::vec3(0.01f)).metal) << "it was not observed";
    const GltfMaterial gold = gltf_material({{0.9f, 0.6f, 0.3f}, 0.2f}, glm::vec3(0));
    expect_close(gold.base_color, glm::vec3(0.9f, 0.6f, 0.3f) * 0.824f, 1e-5f);
    expect_close(ward_of(gold).ks, {0.9f, 0.6f, 0.3f}, 1e-5f);
}

TEST(GltfMaterial, ExtremesStayWithinWhatGltfAllows) {
    const GltfMaterial mirror = gltf_material({glm::vec3(2), 1e-6f}, kGrey);
    EXPECT_EQ(mirror.roughness, 0.045f);
    EXPECT_NEAR(mirror.ior, 7.873f, 0.001f);
    EXPECT_EQ(gltf_material({glm::vec3(2), 1e-6f}, kGrey, GltfFresnel::kConstant).specular, 0.98f);
    EXPECT_EQ(gltf_material({glm::vec3(0.1f), 1}, kGrey).roughness, 1);
}

}  // namespace
}  // namespace patina::gltf_material_test
