#pragma once

#include <QRandomGenerator>
#include <QtTest>

/// The seed of a test's random numbers: $HERMES_SEED, else a new one. It is printed, so that a failure can be
/// repeated.
inline unsigned newSeed() {
    bool isGiven = false;
    const unsigned given = qEnvironmentVariable("HERMES_SEED").toUInt(&isGiven);
    const unsigned seed = isGiven ? given : QRandomGenerator::global()->generate();
    qInfo("HERMES_SEED=%u", seed);
    return seed;
}
