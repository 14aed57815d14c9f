#include "passes/state/network.h"

#include "tests/export/throws.h"
#include "tools/bench/random_network.h"

namespace patina::network_test {
namespace {

using test::throws_error_with;

auto shapes_of(const NetworkDescription& network) {
    return [=] { activation_shapes(network); };
}

TEST(NetworkShapes, AreThoseOfHemiCnn) {
    const NetworkDescription network = random_hemi_network(1);
    const std::vector<ActivationShape> expected{
        {25, 15, 3}, {25, 15, 16},         {25, 15, 32},         {25, 7, 32},         {25, 7, 48},       {25, 3, 48},
        {25, 1, 64}, {1, 1, 128, 2, true}, {1, 1, 128, 1, true}, {1, 1, 64, 1, true}, {1, 1, 7, 1, true}};
    EXPECT_EQ(activation_shapes(network), expected);
    size_t parameters = 0;
    for (const NetworkLayer& layer : network.layers) parameters += layer.weight.size() + layer.bias.size();
    EXPECT_EQ(parameters, 71895u);
}

TEST(NetworkShapes, LayersThatCannotFollowOneAnotherAreRefused) {
    const NetworkDescription good = random_hemi_network(1);
    NetworkDescription bad = good;
    bad.source = "net";
    bad.layers.erase(bad.layers.begin() + 6);
    EXPECT_THAT(shapes_of(bad), throws_error_with("net: layer 'full1' must come after the samples are pooled"));
    bad = good;
    bad.layers[5].pad = 2;
    EXPECT_THAT(shapes_of(bad), throws_error_with("layer 'conv4' has pad 2, it can be 0 or 1"));
    bad = good;
    bad.side = 9;
    EXPECT_THAT(shapes_of(bad), throws_error_with("layer 'conv4' needs an image of at least 3 pixels a side"));
    bad = good;
    bad.side = 2;
    EXPECT_THAT(shapes_of(bad), throws_error_with("layer 'pool3' needs an image of at least 2 pixels a side"));
    bad = good;
    bad.samples = 0;
    EXPECT_THAT(shapes_of(bad), throws_error_with("samples, side and channels must be at least 1"));
}

TEST(NetworkShapes, WeightsThatAreTooFewOrTooManyAreRefused) {
    NetworkDescription bad = random_hemi_network(1);
    bad.layers[1].weight.pop_back();
    EXPECT_THAT(shapes_of(bad), throws_error_with("layer 'conv2' has 4607 weights, its shape asks for 4608"));
    bad = random_hemi_network(1);
    bad.layers[8].bias.push_back(0);
    EXPECT_THAT(shapes_of(bad), throws_error_with("layer 'full2' has 65 biases, its shape asks for 64"));
}

}  // namespace
}  // namespace patina::network_test
