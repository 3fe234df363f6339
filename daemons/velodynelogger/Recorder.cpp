#include "daemons/velodynelogger/Recorder.h"

#include <chrono>

namespace hermes {

namespace {

constexpr std::chrono::seconds flushPeriod{1};          // what a crash may cost
constexpr std::chrono::milliseconds collectPeriod{100}; // rather than to wake up for each packet
constexpr std::size_t collectBytes = 256 * 1024;

} // namespace

void Recorder::Batch::clear() {
    datagrams.clear();
    bytes.clear();
}

Recorder::Recorder(std::size_t capacity)
    : capacity_(capacity) {}

Recorder::~Recorder() {
    stop();
}

std::string Recorder::start(const std::string &path) {
    stop();
    if (!writer_.open(path))
        return writer_.error();
    const std::lock_guard<std::mutex> lock(mutex_);
    status_ = Status();
    status_.recording = true;
    status_.path = path;
    status_.bytes = writer_.bytes();
    stopping_ = false;
    queue_.clear();
    accepted_ = 0;
    thread_ = std::thread([this] { run(); });
    return {};
}

std::string Recorder::stop() {
    {
        const std::lock_guard<std::mutex> lock(mutex_);
        stopping_ = true;
    }
    filled_.notify_all();
    emptied_.notify_all();
    if (thread_.joinable())
        thread_.join();
    return status().error;
}

void Recorder::push(const Datagram &datagram, bool wait) {
    std::unique_lock<std::mutex> lock(mutex_);
    const auto fits = [&] { return queue_.bytes.size() + datagram.size <= capacity_; };
    if (wait)
        emptied_.wait(lock, [&] { return fits() || !status_.recording || stopping_; });
    if (!status_.recording || stopping_)
        return;
    if (!fits()) {
        ++status_.dropped;
        return;
    }
    queue_.datagrams.push_back(datagram);
    queue_.bytes.insert(queue_.bytes.end(), datagram.payload, datagram.payload + datagram.size);
    ++accepted_;
    if (queue_.bytes.size() >= collectBytes)
        filled_.notify_one();
}

bool Recorder::isRecording() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return status_.recording;
}

Recorder::Status Recorder::status() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return status_;
}

void Recorder::run() {
    Batch batch;
    auto nextFlush = std::chrono::steady_clock::now() + flushPeriod;
    bool writing = true;
    bool stopping = false;
    while (writing && !stopping) {
        {
            std::unique_lock<std::mutex> lock(mutex_);
            filled_.wait_for(lock, collectPeriod,
                             [this] { return stopping_ || queue_.bytes.size() >= collectBytes; });
            stopping = stopping_;
            std::swap(batch, queue_);
        }
        emptied_.notify_all();
        writing = write(batch);
        if (writing && std::chrono::steady_clock::now() >= nextFlush) {
            writing = writer_.flush();
            nextFlush = std::chrono::steady_clock::now() + flushPeriod;
        }
        const std::lock_guard<std::mutex> lock(mutex_);
        status_.packets = writer_.packets();
        status_.bytes = writer_.bytes();
        batch.clear();
    }
    const bool closed = writer_.close();
    const std::lock_guard<std::mutex> lock(mutex_);
    status_.recording = false;
    status_.bytes = writer_.bytes();
    status_.packets = writer_.packets();
    status_.dropped += accepted_ - writer_.packets();
    if (!closed)
        status_.error = writer_.error();
    emptied_.notify_all();
}

bool Recorder::write(const Batch &batch) {
    std::size_t offset = 0;
    for (Datagram datagram : batch.datagrams) {
        datagram.payload = batch.bytes.data() + offset;
        offset += datagram.size;
        if (!writer_.write(datagram))
            return false;
    }
    return true;
}

} // namespace hermes
