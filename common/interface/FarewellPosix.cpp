#include "common/interface/Farewell.h"

#include "common/interface/Descriptors.h"

#include <QSocketNotifier>
#include <QTimer>
#include <array>
#include <chrono>
#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

namespace hermes {
namespace {

constexpr std::chrono::seconds farewellLimit{1};
constexpr std::size_t drainAtOnceBytes = 64 << 10;
constexpr int maxFarewells = 32; // at the same time

int farewells = 0; // now; all are in the main thread

class Farewell : public QObject {
public:
    Farewell(int ownDescriptor, QObject *theParent)
        : QObject(theParent)
        , descriptor_(ownDescriptor)
        , notifier_(ownDescriptor, QSocketNotifier::Read) {
        ++farewells;
        connect(&notifier_, &QSocketNotifier::activated, this, &Farewell::drain);
        connect(&limit_, &QTimer::timeout, this, &QObject::deleteLater);
        limit_.setSingleShot(true);
        limit_.start(farewellLimit);
    }
    ~Farewell() override {
        --farewells;
        notifier_.setEnabled(false);
        ::close(descriptor_);
    }

private:
    void drain() {
        static std::array<char, drainAtOnceBytes> nowhere;
        if (::recv(descriptor_, nowhere.data(), nowhere.size(), MSG_DONTWAIT) > 0)
            return;
        notifier_.setEnabled(false);
        deleteLater();
    }

    const int descriptor_;
    QSocketNotifier notifier_;
    QTimer limit_;
};

} // namespace

void sayFarewell(int socket, QObject *parent) {
    if (farewells >= maxFarewells)
        return;
    const int own = ::fcntl(socket, F_DUPFD_CLOEXEC, 0);
    if (own < 0 || descriptorsLeftAfter(own) < spareDescriptors) {
        ::close(own);
        return;
    }
    ::shutdown(own, SHUT_WR);
    new Farewell(own, parent);
}

} // namespace hermes
