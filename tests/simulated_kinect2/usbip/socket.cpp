#include "tests/simulated_kinect2/usbip/socket.h"

#include <cerrno>
#include <cstring>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include "engine/core/error.h"

namespace patina::sensor::kinect2::testing::usbip {
namespace {

int check(int result, const char* what) {
    if (result < 0) throw Error(what, ": ", std::strerror(errno));
    return result;
}

sockaddr_in loopback(uint16_t port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return address;
}

void send_at_once(const Socket& socket) {
    const int on = 1;
    check(setsockopt(socket.descriptor(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on), "TCP_NODELAY");
}

}  // namespace

Socket& Socket::operator=(Socket&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
}

Socket::~Socket() {
    if (descriptor_ >= 0) close(descriptor_);
}

Socket Socket::listen(uint16_t port) {
    Socket socket(check(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0), "opening a socket"));
    const int on = 1;
    check(setsockopt(socket.descriptor_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on), "SO_REUSEADDR");
    const sockaddr_in address = loopback(port);
    check(bind(socket.descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address), "taking the port");
    check(::listen(socket.descriptor_, 1), "listening");
    return socket;
}

Socket Socket::connect(uint16_t port) {
    Socket socket(check(::socket(AF_INET, SOCK_STREAM, 0), "opening a socket"));
    const sockaddr_in address = loopback(port);
    check(::connect(socket.descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address), "connecting");
    send_at_once(socket);
    return socket;
}

Socket Socket::accept() const {
    Socket socket(check(accept4(descriptor_, nullptr, nullptr, SOCK_CLOEXEC), "waiting for a host"));
    send_at_once(socket);
    return socket;
}

bool Socket::read(std::span<uint8_t> bytes) const {
    while (!bytes.empty()) {
        const ssize_t count = recv(descriptor_, bytes.data(), bytes.size(), MSG_WAITALL);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        bytes = bytes.subspan(static_cast<size_t>(count));
    }
    return true;
}

bool Socket::write(std::span<const uint8_t> bytes) const {
    while (!bytes.empty()) {
        const ssize_t count = send(descriptor_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        bytes = bytes.subspan(static_cast<size_t>(count));
    }
    return true;
}

void Socket::shut_down() const { shutdown(descriptor_, SHUT_RDWR); }

}  // namespace patina::sensor::kinect2::testing::usbip
