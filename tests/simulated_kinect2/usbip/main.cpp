// A simulated Kinect v2 that a Linux kernel takes for a device on its USB, by USB/IP:
//   kinect2_usbip serve [PORT]    offers it on the loopback interface; each host that attaches it gets a new one
//   kinect2_usbip attach [PORT]   attaches it to this machine's vhci-hcd, as `usbip attach` does; needs root
// The environment changes what it does (bus_options.h). Breaches of the device's protocol are printed.

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>

#include "engine/core/error.h"
#include "tests/simulated_kinect2/usbip/attached_device.h"

namespace {

using namespace patina;
using namespace patina::sensor::kinect2::testing;
using namespace patina::sensor::kinect2::testing::usbip;

constexpr const char* kController = "/sys/devices/platform/vhci_hcd.0/";

[[noreturn]] void serve(uint16_t port) {
    const Socket listener = Socket::listen(port);
    std::puts("kinect2_usbip: ready");
    std::fflush(stdout);
    while (true) {
        Socket host = listener.accept();
        const std::optional<Request> request = read_request(host);
        if (!request) continue;
        const bool found = request->operation == Operation::kList || request->bus_name == kBusName;
        if (!write_answer(host, request->operation, found) || !found || request->operation == Operation::kList)
            continue;
        AttachedDevice device(std::move(host), BusOptions::from_environment());
        device.serve();
        if (!device.complaint().empty()) std::printf("kinect2_usbip: %s\n", device.complaint().c_str());
        std::fflush(stdout);
    }
}

/// A SuperSpeed port of the controller with nothing at it. Throws Error.
std::string free_port() {
    constexpr const char* kNothing = "004";
    std::ifstream list(std::string(kController) + "status");
    for (std::string line; std::getline(list, line);) {
        std::istringstream words(line);
        std::string hub, port, state;
        words >> hub >> port >> state;
        if (hub == "ss" && state == kNothing) return port;
    }
    throw Error(kController, "status names no free port of SuperSpeed; is vhci-hcd loaded?");
}

void attach(uint16_t port) {
    const Socket server = Socket::connect(port);
    if (!write_request(server, {Operation::kImport, kBusName}) || !read_import_answer(server)) {
        throw Error("port ", port, " does not offer the device ", kBusName);
    }
    std::ofstream attach(std::string(kController) + "attach");
    attach << free_port() << ' ' << server.descriptor() << ' ' << kDevice << ' ' << kSuperSpeed << std::flush;
    if (!attach) throw Error(kController, "attach refuses the device");
}

}  // namespace

int main(int argc, char** argv) {
    const std::string command = argc > 1 ? argv[1] : "";
    const auto port = static_cast<uint16_t>(argc > 2 ? std::atoi(argv[2]) : kPort);
    try {
        if (command == "serve") serve(port);
        if (command == "attach") {
            attach(port);
            return 0;
        }
    } catch (const std::exception& error) {
        std::fprintf(stderr, "kinect2_usbip: %s\n", error.what());
        return 1;
    }
    std::fputs("usage: kinect2_usbip serve|attach [PORT]\n", stderr);
    return 2;
}
