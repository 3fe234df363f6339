#pragma once

#include "common/client/Client.h"

#include <QTest>

/// Ends an emergency stop as a person does who confirms: once the daemon allows it. False: it refuses.
inline bool releaseStop(hermes::Client &client, QJsonObject params = {}) {
    params.insert("confirm", true);
    for (int tries = 0; tries < 200; ++tries) {
        const auto released = client.callAndWait("motor.reset_estop", params);
        if (released)
            return true;
        if (!released.error().is(hermes::ErrorCode::NotReady))
            return false; // else too early, wheels that turn, or the machine stood still meanwhile
        QTest::qWait(50);
    }
    return false;
}
