#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "sensor/kinect2/transport.h"
#include "sensor/kinect2/usb_library.h"

namespace patina::sensor::kinect2::usb {

/// The transfers of both streams in flight, and the event thread on which they complete. The thread exchanges a filled
/// buffer with the sink and submits the transfer again; it copies nothing.
class Streams {
  public:
    /// Allocates the transfers. `name`: the device, for messages.
    Streams(libusb_context* context, libusb_device_handle* handle, TransferSink& sink, std::string name);
    /// Needs stop() first. If that returned false, the handle has to be closed before.
    ~Streams() = default;
    Streams(const Streams&) = delete;
    Streams& operator=(const Streams&) = delete;

    /// Submits all transfers. Throws Unplugged, or Error when too few can be submitted; stop() has to follow all the
    /// same.
    void start();

    /// Cancels all transfers and waits for them. No call to the sink follows. False: some did not come back, and the
    /// system may still write to their buffers until the handle is closed.
    bool stop() noexcept;

    /// What was granted less than asked for; empty: nothing.
    const std::string& warning() const { return warning_; }

  private:
    using TransferPtr = std::unique_ptr<libusb_transfer, Release<libusb_free_transfer>>;

    struct Slot {
        Slot(Streams& owner, libusb_device_handle* handle, StreamKind kind);
        void fill(libusb_device_handle* handle);
        void read_result();

        Streams& streams;
        Transfer buffer;
        TransferPtr transfer;
        bool follows_gap = false;  ///< the device had no transfer to fill before this one was submitted
    };

    /// The transfers of one kind.
    struct Ring {
        std::vector<std::unique_ptr<Slot>> slots;
        std::vector<Slot*> idle;  ///< could not be submitted again; tried with each one that completes
        size_t in_flight = 0;
        uint32_t failures = 0;  ///< transfers in a row that failed
    };

    Ring& ring(StreamKind kind) { return kind == StreamKind::kColor ? color_ : infrared_; }
    void add_slots(StreamKind kind, size_t count, libusb_device_handle* handle);
    void submit_all(StreamKind kind);
    static void LIBUSB_CALL completed(libusb_transfer* transfer);
    void on_completed(Slot& slot);
    bool stalled(size_t in_flight);
    int submit(Slot& slot);
    void submit_again(Slot& slot);
    void end(bool unplugged, const std::string& reason);
    void handle_events();

    libusb_context* context_;
    TransferSink& sink_;
    std::string name_;
    std::string warning_;

    std::mutex mutex_;  ///< of what follows
    std::condition_variable returned_;
    Ring color_, infrared_;
    bool stopping_ = false, ended_ = false;

    std::chrono::steady_clock::time_point last_infrared_{};  ///< of the event thread alone
    std::atomic<bool> quit_ = false;
    std::thread thread_;
};

}  // namespace patina::sensor::kinect2::usb
