#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>

namespace patina::sensor::kinect2::testing::usbip {

/// A connected or listening TCP socket; closed with the object.
class Socket {
  public:
    Socket() = default;
    explicit Socket(int descriptor) : descriptor_(descriptor) {}
    Socket(Socket&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
    Socket& operator=(Socket&& other) noexcept;
    ~Socket();

    /// Listens on the loopback interface alone. Throws Error.
    static Socket listen(uint16_t port);
    /// Connects to this machine. Throws Error.
    static Socket connect(uint16_t port);
    /// Waits for the next host. Throws Error.
    Socket accept() const;

    /// False: the other side is gone.
    bool read(std::span<uint8_t> bytes) const;
    bool write(std::span<const uint8_t> bytes) const;
    /// Reads that wait, and all that follow, return false.
    void shut_down() const;

    int descriptor() const { return descriptor_; }

  private:
    int descriptor_ = -1;
};

}  // namespace patina::sensor::kinect2::testing::usbip
