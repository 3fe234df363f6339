#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

namespace hermes {

/// The thread that plays a recording and its pace, the time of the replay: others let it wait, seek and end
/// it. A seek while it waits plays a quarter of a second at once, which is a whole turn of a lidar, so that
/// the place can be seen; the time stays that of the seek.
class Playback {
public:
    struct Options {
        double speed = 1; ///< 1 is real time; 0: everything is due at once
        bool loop = false;
        /// From the beginning. What holds nothing is at its end only when it goes on.
        bool paused = false;
    };
    struct Status {
        double position_s = 0; ///< after the beginning, of what was played last
        bool paused = false;
        std::uint64_t loops = 0; ///< how often it began anew
    };
    enum class Turn { Due, Seek, End };

    ~Playback() { stop(); }

    /// Calls a function in a thread of its own, at time 0. It asks waitFor() before all that it plays.
    void start(const Options &options, std::function<void()> play);
    /// The thread has ended when it returns.
    void stop();
    void setPaused(bool paused);
    void seek(double time_s);
    /// The time of the replay goes on from where it is.
    void setSpeed(double speed);
    Status status() const;
    /// Of the thread that calls setSpeed().
    const Options &options() const { return options_; }

    /// Until this time of the replay has come. The playing thread's, as what follows.
    Turn waitFor(std::int64_t time_ns);
    /// At the end of what there is: Due when it does not wait.
    Turn waitToEnd();
    /// A pause for other reasons; false when the replay is to end.
    bool rest(std::chrono::milliseconds time);
    /// The time that was sought last. After Turn::Seek.
    std::int64_t takeSeek();
    /// Somebody seeks or ends it.
    bool isInterrupted() const;
    /// The replay goes on at this time.
    void jump(std::int64_t time_ns);
    /// It begins anew.
    void loop();

private:
    using Clock = std::chrono::steady_clock;

    static constexpr std::int64_t preview_ns = 250000000;

    bool isPreview(std::int64_t time_ns) const;
    void change(const std::function<void()> &what);
    void hold();
    Clock::time_point due(std::int64_t time_ns) const;

    Options options_;
    std::thread thread_;

    mutable std::mutex mutex_; // guards what follows
    std::condition_variable wake_;
    bool stopping_ = false;
    bool paused_ = false;
    std::optional<std::int64_t> seek_ns_;
    std::int64_t position_ns_ = 0;
    std::uint64_t loops_ = 0;
    std::optional<Clock::time_point> since_; ///< when the time was that of begin_ns_; nothing: it waits there
    std::int64_t begin_ns_ = 0;
    std::optional<std::int64_t> sought_ns_; ///< the last seek, until the time goes on
};

} // namespace hermes
