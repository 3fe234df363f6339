// What is recorded is on the disk within a second, and nobody waits for it.
#include "common/ports/SerialRecorder.h"
#include "common/recording/Recording.h"
#include "daemons/velodynelogger/Recorder.h"
#include "tests/daemons/MachineStalls.h"
#include "tests/support/Sensor.h"

#include <sys/syscall.h>

using namespace hermes;
using namespace hermes::velodynelogger;
using Clock = std::chrono::steady_clock;

/// So many bytes of a file are on the disk at this time.
struct Sync {
    std::string path;
    std::int64_t bytes;
    Clock::time_point done;
    std::thread::id thread;
};

static std::mutex mutex;
static std::vector<Sync> syncs;
static std::atomic<int> diskTime_ms{0};
static std::atomic<bool> diskFails{false};

static std::vector<Sync> syncsOf(const std::string &path) {
    const std::lock_guard<std::mutex> lock(mutex);
    std::vector<Sync> found;
    std::copy_if(syncs.begin(), syncs.end(), std::back_inserter(found),
                 [&](const Sync &sync) { return sync.path == path; });
    return found;
}

/// In place of that of the system, for all of this process.
extern "C" int fdatasync(int file) {
    char path[4096] = {};
    if (::readlink(("/proc/self/fd/" + std::to_string(file)).c_str(), path, sizeof(path) - 1) < 0)
        qFatal("a sync of no file");
    struct stat state {};
    ::fstat(file, &state);
    std::this_thread::sleep_for(std::chrono::milliseconds(diskTime_ms));
    if (diskFails) {
        errno = EIO;
        return -1;
    }
    const int result = int(::syscall(SYS_fdatasync, file));
    const std::lock_guard<std::mutex> lock(mutex);
    syncs.push_back({path, std::int64_t(state.st_size), Clock::now(), std::this_thread::get_id()});
    return result;
}

/// A logger's recorder without its daemon, and somebody who receives.
class Rig {
public:
    Rig(const QString &root, const QString &kind)
        : isLidar_(kind == "velodynelogger") {
        serial_.setPorts({{"gps", "", &queue_}});
        recording_ =
            std::make_unique<Recording>(kind, settings_, health_, writer(), Recording::Files::Several);
        const QJsonObject values{{"folder", root},
                                 {"free_floor_bytes", 0},
                                 {"free_warn_bytes", 0},
                                 {"file_bytes", 1000000}}; // a lidar begins a new file in half a second
        if (!settings_.set({{"record", values}}).ok())
            qFatal("settings are refused");
        recording_->open();
    }

    Result<QJsonValue> call(const QString &method, const QJsonObject &params = {}) {
        std::optional<Result<QJsonValue>> answer;
        for (const Command &command : recording_->commands())
            if (command.name() == method)
                command.execute(params, Call(),
                                Reply([&](const Result<QJsonValue> &result) { answer = result; }));
        if (!QTest::qWaitFor([&] { return answer.has_value(); }, slowness * 20000))
            qFatal("no answer came");
        return *answer;
    }

    /// Receives for a while, in a thread of its own, 1,800 times a second.
    void receive(std::chrono::milliseconds time) {
        std::thread receiver([&] {
            receiver_ = std::this_thread::get_id();
            const auto end = Clock::now() + time;
            for (auto due = Clock::now(); due < end; due += std::chrono::microseconds(553)) {
                std::this_thread::sleep_until(due);
                const auto begun = Clock::now();
                pushOne();
                longestPush_ = std::max(longestPush_, Clock::now() - begun);
                came_.push_back(begun);
            }
            received_ = true;
        });
        QElapsedTimer turn;
        while (!received_) {
            turn.start();
            QTest::qWait(1);
            longestTurn_ms = std::max(longestTurn_ms, turn.elapsed());
        }
        receiver.join();
    }

    /// The longest time from what came to that it was on the disk, in seconds, of what came some time before
    /// the end.
    double longestDelay(const QString &folder) const {
        double longest = 0;
        const auto end = came_.back() - std::chrono::seconds(2);
        for (std::size_t i = 0; i < came_.size() && came_[i] < end; i += 20) {
            auto first = Clock::time_point::max();
            const auto [file, bytes] = placeOf(i);
            for (const Sync &sync : syncsOf((folder + '/' + file).toStdString()))
                if (sync.bytes >= bytes)
                    first = std::min(first, sync.done);
            if (first == Clock::time_point::max())
                return 1e9; // never
            longest = std::max(longest, std::chrono::duration<double>(first - came_[i]).count());
        }
        return longest;
    }
    double lost() {
        double sum = 0;
        for (const double loss : writer().state().losses)
            sum += loss;
        return sum;
    }
    double longestPush_s() const { return std::chrono::duration<double>(longestPush_).count(); }
    std::thread::id receiver() const { return receiver_; }
    bool isActive() const { return recording_->isActive(); }

    qint64 longestTurn_ms = 0; ///< of the event loop

private:
    static constexpr int record = 16 + 42 + 1206, perFile = (1000000 - 24) / record;

    RecordingWriter &writer() {
        return isLidar_ ? static_cast<RecordingWriter &>(lidar_) : static_cast<RecordingWriter &>(serial_);
    }
    void pushOne() {
        const int number = int(came_.size());
        if (isLidar_)
            lidar_.push(sensorDatagram(sensor_.packet(number), sensor_.stamp(number)), false);
        else
            queue_.push("0123456789", 10, Moment::now());
    }
    /// Which file the n-th is in, and how long the file is with it.
    std::pair<QString, std::int64_t> placeOf(std::size_t n) const {
        if (!isLidar_)
            return {"seriallogger-gps.raw", std::int64_t(n + 1) * 10};
        return {QString("velodynelogger-%1.pcap").arg(n / perFile + 1, 4, 10, QChar('0')),
                24 + std::int64_t(n % perFile + 1) * record};
    }

    const bool isLidar_;
    Settings settings_;
    Health health_{nullptr};
    Sensor sensor_;
    ChunkQueue queue_{1 << 20};
    Recorder lidar_;
    SerialRecorder serial_;
    std::unique_ptr<Recording> recording_;
    std::vector<Clock::time_point> came_;
    Clock::duration longestPush_{};
    std::thread::id receiver_;
    std::atomic<bool> received_{false};
};

class TestRecordingSync : public QObject {
    Q_OBJECT
private Q_SLOTS:
    void init() {
        diskTime_ms = 0;
        diskFails = false;
        const std::lock_guard<std::mutex> lock(mutex);
        syncs.clear();
    }
    void whatCameIsOnTheDiskWithinASecond_data() { kinds(); }

    /// Of three times the best: a machine that is busy with other things does not say anything of the
    /// program.
    void whatCameIsOnTheDiskWithinASecond() {
        QFETCH(QString, kind);
        double delay = 1e9;
        for (int attempt = 0; attempt < 3 && delay >= 1; ++attempt) {
            QTemporaryDir root;
            Rig rig(root.path(), kind);
            QVERIFY(rig.call("record.start", {{"name", "run1"}}).ok());
            rig.receive(std::chrono::seconds(5));
            QVERIFY(rig.call("record.stop").ok());
            QCOMPARE(rig.lost(), 0.0);
            delay = rig.longestDelay(root.path() + "/run1");
            qInfo("%s: on the disk after %.2f s at the latest", qPrintable(kind), delay);
            QVERIFY(delay < 1e8);
        }
        QVERIFY(delay < slowness * 1.0);
    }

    void nobodyWaitsForASlowDisk_data() { kinds(); }

    void nobodyWaitsForASlowDisk() {
        QFETCH(QString, kind);
        QTemporaryDir root;
        Rig rig(root.path(), kind);
        QVERIFY(rig.call("record.start", {{"name", "run1"}}).ok());
        diskTime_ms = 1500;
        MachineStalls stalls;
        rig.receive(std::chrono::seconds(6));
        const double stall_s = stalls.takeLongest();
        diskTime_ms = 0;
        qInfo("%s: to take what came took %.1f ms at the longest, a turn of the event loop %lld ms; stalls "
              "%.1f ms",
              qPrintable(kind), rig.longestPush_s() * 1e3, rig.longestTurn_ms, stall_s * 1e3);
        QVERIFY(rig.longestPush_s() < 0.3 + stall_s); // waiting, it would have been 1.5 s
        QVERIFY(double(rig.longestTurn_ms) * 1e-3 < slowness * 0.5 + stall_s);
        QVERIFY(rig.call("record.stop").ok());
        QCOMPARE(rig.lost(), 0.0);
        const std::lock_guard<std::mutex> lock(mutex);
        for (const Sync &sync : syncs)
            QVERIFY(sync.thread != rig.receiver());
    }

    void aDiskThatFailsEndsTheRecording_data() { kinds(); }

    void aDiskThatFailsEndsTheRecording() {
        QFETCH(QString, kind);
        QTemporaryDir root;
        Rig rig(root.path(), kind);
        QVERIFY(rig.call("record.start", {{"name", "run1"}}).ok());
        rig.receive(std::chrono::milliseconds(100));
        diskFails = true;
        QTRY_VERIFY(!rig.isActive());
        diskFails = false;
        const Error told = rig.call("record.stop").error();
        VERIFY_CONTAINS(told.message, "cannot be written to the disk");
        QVERIFY(told.data.toObject().value("path").toString().startsWith(root.path() + "/run1/" + kind));
    }

private:
    static void kinds() {
        const Rows<QString> row("kind");
        row("lidar", "velodynelogger");
        row("serial", "seriallogger");
    }
};
