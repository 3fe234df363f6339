#include "daemons/velodynelogger/PcapPlayer.h"

namespace hermes {

PcapPlayer::PcapPlayer(Sink sink, End end)
    : m_sink(std::move(sink))
    , m_end(std::move(end)) {}

PcapPlayer::~PcapPlayer() {
    stop();
}

std::string PcapPlayer::start(const std::string &path, double speed) {
    stop();
    if (!m_reader.open(path))
        return m_reader.error();
    m_speed = speed;
    m_stopping = false;
    m_played = 0;
    m_thread = std::thread([this] { run(); });
    return {};
}

void PcapPlayer::stop() {
    {
        const std::lock_guard<std::mutex> lock(m_mutex);
        m_stopping = true;
    }
    m_wake.notify_all();
    if (m_thread.joinable())
        m_thread.join();
    m_reader.close();
}

std::uint64_t PcapPlayer::played() const {
    const std::lock_guard<std::mutex> lock(m_mutex);
    return m_played;
}

void PcapPlayer::run() {
    using Clock = std::chrono::steady_clock;
    Clock::time_point begin = Clock::now();
    std::int64_t first_ns = 0;
    Datagram datagram;
    PcapReader::Next next;
    bool started = false;
    while ((next = m_reader.next(datagram)) == PcapReader::Next::Datagram) {
        if (!started) {
            first_ns = datagram.stamp_ns;
            started = true;
        }
        const auto since = std::chrono::nanoseconds(
            m_speed > 0 ? std::int64_t(double(datagram.stamp_ns - first_ns) / m_speed) : 0);
        if (!waitUntil(begin + since))
            return;
        m_sink(datagram);
    }
    if (waitUntil(begin))
        m_end(next == PcapReader::Next::Failed ? m_reader.error() : std::string());
}

bool PcapPlayer::waitUntil(std::chrono::steady_clock::time_point due) {
    std::unique_lock<std::mutex> lock(m_mutex);
    m_wake.wait_until(lock, due, [this] { return m_stopping; });
    m_played += m_stopping ? 0 : 1;
    return !m_stopping;
}

} // namespace hermes
