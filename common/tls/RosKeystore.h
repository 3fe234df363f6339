#pragma once

#include "common/Result.h"

namespace hermes {

/// Keys for DDS security, laid out as SROS2 does: KEYSTORE/public, private and enclaves/NAME. ROS 2 reads
/// them with ROS_SECURITY_KEYSTORE=KEYSTORE and --enclave /NAME. Source: ros2/sros2, keystore.
class RosKeystore {
public:
    explicit RosKeystore(QString folder)
        : folder_(std::move(folder)) {}

    /// Keys for a node, robot or laptop; the store is made where there is none. canCommand: it may publish
    /// and call everything; else it reads, and publishes what each node does of itself. Gives the folder of
    /// the enclave. Errors: there is one of that name, a name that cannot be one, a store without its
    /// authority, the disk.
    Result<QString> addEnclave(const QString &name, bool canCommand, int days) const;

private:
    Result<void> make(int days) const;
    Result<void> save(const QString &file, const QByteArray &bytes, bool isSecret = false) const;
    Result<QByteArray> load(const QString &file) const;

    const QString folder_;
};

} // namespace hermes
