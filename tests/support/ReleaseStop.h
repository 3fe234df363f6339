#pragma once

#include "common/client/Client.h"

#include <QTest>

/// Ends an emergency stop as a person does who confirms: once the daemon allows it. False: it refuses.
inline bool releaseStop(hermes::Client &client, QJsonObject params = {}) {
    params.insert("confirm", true);
    for (int tries = 0; tries < 100; ++tries) {
        const auto released = client.callAndWait("motor.reset_estop", params);
        if (released)
            return true;
        const double wait_s = released.error().data["retry_after_s"].toDouble();
        if (!(wait_s > 0) && !released.error().message.contains("expected wheels that stand"))
            return false;
        QTest::qWait(int(wait_s * 1000) + 10);
    }
    return false;
}
