#include "export/gltf_material.h"

#include <gtest/gtest.h>

namespace patina {
namespace {

constexpr glm::vec3 kGrey(0.5f);

void expect_close(glm::vec3 got, glm::vec3 expected, float relative) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(got[c], expected[c], relative * expected[c]) << c;
}

TEST(GltfMaterial, ConvertsBackToKdKsAndAlpha) {
    for (const float alpha : {0.005f, 0.05f, 0.2f, 0.5f, 1.0f}) {
        for (const glm::vec3 ks : {glm::vec3(0.02f), glm::vec3(0.3f, 0.2f, 0.05f), glm::vec3(0.9f, 0.6f, 0.1f)}) {
            for (const glm::vec3 kd : {glm::vec3(0.6f, 0.3f, 0.1f), glm::vec3(0.01f)}) {
                const GltfMaterial material = gltf_material({ks, alpha}, kd);
                const WardGloss back = ward_of(material);
                expect_close(back.ks, ks, 1e-4f);
                EXPECT_NEAR(back.alpha, alpha, 1e-4f * alpha);
                if (!material.metal) expect_close(kd_of(material, base_color_of(material, kd)), kd, 1e-5f);
            }
        }
    }
}

TEST(GltfMaterial, IsAsStrongAtNormalIncidenceAsFresnelSays) {
    // F0 = min(0.04 colour, 1) factor, and the lobe of ks 0.1 at alpha 0.4 has 0.1 (0.868 - 0.22 0.4).
    const GltfMaterial material = gltf_material({{0.1f, 0.05f, 0}, 0.4f}, kGrey);
    expect_close(0.04f * material.specular_color * material.specular, {0.078f, 0.039f, 0}, 1e-5f);
    EXPECT_NEAR(material.specular, 0.078f, 1e-6f) << "F90 is the strongest channel's F0: it does not change with angle";
    EXPECT_NEAR(material.roughness * material.roughness, 0.4f, 1e-6f);
    expect_close(base_color_of(material, kGrey), kGrey / 0.922f, 1e-5f);
}

TEST(GltfMaterial, WithoutKsIsDiffuseAlone) {
    const GltfMaterial material = gltf_material({glm::vec3(0), 1}, kGrey);
    EXPECT_EQ(material.specular, 0);
    EXPECT_FALSE(material.metal);
    EXPECT_EQ(base_color_of(material, kGrey), kGrey);
}

TEST(GltfMaterial, IsAMetalWhereItIsBrightAndNotDiffuse) {
    EXPECT_TRUE(gltf_material({glm::vec3(0.5f), 0.2f}, glm::vec3(0.01f)).metal);
    EXPECT_FALSE(gltf_material({glm::vec3(0.5f), 0.2f}, glm::vec3(0.1f)).metal);
    EXPECT_FALSE(gltf_material({glm::vec3(0.2f), 0.2f}, glm::vec3(0.01f)).metal);
}

TEST(GltfMaterial, ExtremesStayWithinWhatGltfAllows) {
    const GltfMaterial mirror = gltf_material({glm::vec3(2), 1e-6f}, kGrey);
    EXPECT_EQ(mirror.roughness, 0.045f);
    EXPECT_EQ(mirror.specular, 0.98f);
    EXPECT_EQ(gltf_material({glm::vec3(0.1f), 1}, kGrey).roughness, 1);
}

}  // namespace
}  // namespace patina
