#include "daemons/scanmatcher/Worker.h"

#include <algorithm>

namespace hermes {

Worker::Worker(Done done)
    : whenDone(std::move(done))
    , thread([this] { run(); }) {}

Worker::~Worker() {
    {
        const std::lock_guard lock(mutex);
        ending = true;
    }
    wake.notify_one();
    thread.join();
}

void Worker::push(Scan scan) {
    {
        const std::lock_guard lock(mutex);
        if (scans >= limit) {
            items.erase(std::find_if(items.begin(), items.end(), [](const Item &i) { return !i.job; }));
            --scans;
            ++lost;
        }
        items.push_back({std::move(scan), {}});
        ++scans;
    }
    wake.notify_one();
}

void Worker::post(Job job) {
    {
        const std::lock_guard lock(mutex);
        items.push_back({{}, std::move(job)});
    }
    wake.notify_one();
}

void Worker::setQueueLimit(size_t count) {
    const std::lock_guard lock(mutex);
    limit = std::max<size_t>(1, count);
}

quint64 Worker::dropped() const {
    const std::lock_guard lock(mutex);
    return lost;
}

size_t Worker::waiting() const {
    const std::lock_guard lock(mutex);
    return scans;
}

void Worker::run() {
    for (;;) {
        Item item;
        {
            std::unique_lock lock(mutex);
            wake.wait(lock, [this] { return ending || !items.empty(); });
            if (items.empty())
                return;
            item = std::move(items.front());
            items.pop_front();
            if (!item.job)
                --scans;
        }
        if (item.job) {
            item.job(tracker);
        } else {
            tracker.process(item.scan.data);
            whenDone(tracker, item.scan);
        }
    }
}

} // namespace hermes
