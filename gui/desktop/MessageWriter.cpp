#include "gui/desktop/MessageWriter.h"

#include <QByteArray>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <deque>
#include <memory>
#include <mutex>
#include <thread>

namespace hermes::desktop {
namespace {

constexpr std::size_t maxLines = 1000;
constexpr std::chrono::milliseconds joinTimeout{200};

/// What waits; of the thread, too, which may be held in a write for ever.
struct Waiting {
    std::mutex mutex;
    std::condition_variable changed;
    std::deque<QByteArray> lines;
    int missing = 0;
    bool isEnding = false, hasEnded = false;
};

std::shared_ptr<Waiting> waiting;

void add(QtMsgType, const QMessageLogContext &, const QString &text) {
    const std::lock_guard<std::mutex> lock(waiting->mutex);
    if (waiting->lines.size() >= maxLines)
        ++waiting->missing;
    else
        waiting->lines.push_back(text.toLocal8Bit() + '\n');
    waiting->changed.notify_all();
}

void write(const std::shared_ptr<Waiting> &what) {
    std::unique_lock<std::mutex> lock(what->mutex);
    for (;;) {
        what->changed.wait(lock, [&] { return what->isEnding || !what->lines.empty(); });
        if (what->lines.empty())
            break;
        const QByteArray line = what->lines.front();
        what->lines.pop_front();
        const int missing = std::exchange(what->missing, 0);
        lock.unlock();
        std::fputs(line.constData(), stderr);
        if (missing > 0)
            std::fprintf(stderr, "%d more messages are missing here: they were not read in time\n", missing);
        lock.lock();
    }
    what->hasEnded = true;
    what->changed.notify_all();
}

} // namespace

MessageWriter::MessageWriter() {
    waiting = std::make_shared<Waiting>();
    std::thread([own = waiting] { write(own); }).detach();
    qInstallMessageHandler(add);
}

MessageWriter::~MessageWriter() {
    qInstallMessageHandler(nullptr);
    std::unique_lock<std::mutex> lock(waiting->mutex);
    waiting->isEnding = true;
    waiting->changed.notify_all();
    waiting->changed.wait_for(lock, joinTimeout, [] { return waiting->hasEnded; });
}

} // namespace hermes::desktop
