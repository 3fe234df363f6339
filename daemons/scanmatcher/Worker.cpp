#include "daemons/scanmatcher/Worker.h"

namespace hermes::scanmatcher {

void Worker::stop() {
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
    }
    wake_.notify_one();
    if (thread_.joinable())
        thread_.join();
}

void Worker::push(Scan scan) {
    const std::lock_guard lock(mutex_);
    if (scans_ >= limit_) {
        items_.erase(std::find_if(items_.begin(), items_.end(), [](const Item &i) { return !i.job; }));
        --scans_;
        ++lost_;
    }
    items_.push_back({std::move(scan), {}});
    ++scans_;
    wake_.notify_one();
}

void Worker::post(Job job) {
    const std::lock_guard lock(mutex_);
    items_.push_back({{}, std::move(job)});
    wake_.notify_one();
}

void Worker::setQueueLimit(size_t count) {
    const std::lock_guard lock(mutex_);
    limit_ = std::max<size_t>(1, count);
}

void Worker::run() {
    for (;;) {
        Item item;
        {
            std::unique_lock lock(mutex_);
            wake_.wait(lock, [this] { return ending_ || !items_.empty(); });
            if (items_.empty())
                return;
            item = std::move(items_.front());
            items_.pop_front();
            if (!item.job)
                --scans_;
        }
        item.job ? item.job() : take_(item.scan);
    }
}

} // namespace hermes::scanmatcher
