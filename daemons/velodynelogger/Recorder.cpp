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
    : m_capacity(capacity) {}

Recorder::~Recorder() {
    stop();
}

std::string Recorder::start(const std::string &path) {
    stop();
    if (!m_writer.open(path))
        return m_writer.error();
    const std::lock_guard<std::mutex> lock(m_mutex);
    m_status = Status();
    m_status.recording = true;
    m_status.path = path;
    m_status.bytes = m_writer.bytes();
    m_stopping = false;
    m_queue.clear();
    m_accepted = 0;
    m_thread = std::thread([this] { run(); });
    return {};
}

std::string Recorder::stop() {
    {
        const std::lock_guard<std::mutex> lock(m_mutex);
        m_stopping = true;
    }
    m_filled.notify_all();
    m_emptied.notify_all();
    if (m_thread.joinable())
        m_thread.join();
    return status().error;
}

void Recorder::push(const Datagram &datagram, bool wait) {
    std::unique_lock<std::mutex> lock(m_mutex);
    const auto fits = [&] { return m_queue.bytes.size() + datagram.size <= m_capacity; };
    if (wait)
        m_emptied.wait(lock, [&] { return fits() || !m_status.recording || m_stopping; });
    if (!m_status.recording || m_stopping)
        return;
    if (!fits()) {
        ++m_status.dropped;
        return;
    }
    m_queue.datagrams.push_back(datagram);
    m_queue.bytes.insert(m_queue.bytes.end(), datagram.payload, datagram.payload + datagram.size);
    ++m_accepted;
    if (m_queue.bytes.size() >= collectBytes)
        m_filled.notify_one();
}

bool Recorder::isRecording() const {
    const std::lock_guard<std::mutex> lock(m_mutex);
    return m_status.recording;
}

Recorder::Status Recorder::status() const {
    const std::lock_guard<std::mutex> lock(m_mutex);
    return m_status;
}

void Recorder::run() {
    Batch batch;
    auto nextFlush = std::chrono::steady_clock::now() + flushPeriod;
    bool writing = true;
    bool stopping = false;
    while (writing && !stopping) {
        {
            std::unique_lock<std::mutex> lock(m_mutex);
            m_filled.wait_for(lock, collectPeriod,
                              [this] { return m_stopping || m_queue.bytes.size() >= collectBytes; });
            stopping = m_stopping;
            std::swap(batch, m_queue);
        }
        m_emptied.notify_all();
        writing = write(batch);
        if (writing && std::chrono::steady_clock::now() >= nextFlush) {
            writing = m_writer.flush();
            nextFlush = std::chrono::steady_clock::now() + flushPeriod;
        }
        const std::lock_guard<std::mutex> lock(m_mutex);
        m_status.packets = m_writer.packets();
        m_status.bytes = m_writer.bytes();
        batch.clear();
    }
    const bool closed = m_writer.close();
    const std::lock_guard<std::mutex> lock(m_mutex);
    m_status.recording = false;
    m_status.bytes = m_writer.bytes();
    m_status.packets = m_writer.packets();
    m_status.dropped += m_accepted - m_writer.packets();
    if (!closed)
        m_status.error = m_writer.error();
    m_emptied.notify_all();
}

bool Recorder::write(const Batch &batch) {
    std::size_t offset = 0;
    for (Datagram datagram : batch.datagrams) {
        datagram.payload = batch.bytes.data() + offset;
        offset += datagram.size;
        if (!m_writer.write(datagram))
            return false;
    }
    return true;
}

} // namespace hermes
