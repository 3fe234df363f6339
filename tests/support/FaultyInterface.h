#pragma once

#include "common/interface/Interface.h"

#include <deque>
#include <functional>
#include <random>
#include <utility>

namespace hermes {

/// How bad a FaultyInterface is. Probabilities apply to each piece written, from 0 to 1.
struct Faults {
    double drop = 0;         ///< the piece is lost
    double flip = 0;         ///< one bit of the piece is inverted
    double split = 0;        ///< the piece arrives in two
    int longestDelay_ms = 0; ///< each piece waits up to this long; order is kept
    unsigned int seed = 1;   ///< the same seed gives the same faults
};

/// Wraps an interface and damages what is written to it and received from it, for tests.
class FaultyInterface : public Interface {
    Q_OBJECT
public:
    /// Takes over inner.
    FaultyInterface(Interface *inner, const Faults &faults, QObject *parent);

    QString name() const override { return QStringLiteral("faulty ") + inner_->name(); }
    bool isDatagram() const override { return inner_->isDatagram(); }
    qint64 bytesToWrite() const override { return inner_->bytesToWrite(); }
    qint64 bytesInSystem() const override { return inner_->bytesInSystem(); }
    double bytesPerSecond() const override { return inner_->bytesPerSecond(); }
    quint64 faultCount() const { return faultsMade_; } ///< drops and flips so far

protected:
    void doOpen() override { inner_->open(); }
    void doClose() override { inner_->close(); }
    bool doWrite(const QByteArray &bytes) override;

private:
    using Delivery = std::function<void(const QByteArray &)>;

    bool chance(double probability);
    void pass(QByteArray bytes, const Delivery &deliver);
    void later(const QByteArray &bytes, const Delivery &deliver);

    Interface *inner_;
    Faults faults_;
    std::mt19937 random_;
    quint64 faultsMade_ = 0;
    std::deque<std::pair<QByteArray, Delivery>> waiting_; // in order
    double lastDue_ = 0; // monotonic; a later piece is never due before an earlier one
};

} // namespace hermes
