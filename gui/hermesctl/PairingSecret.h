#pragma once

#include <array>
#include <openssl/crypto.h>

namespace hermes::ctl {

/// The key that both sides of a pairing make of its code. Each copy is wiped when it goes.
struct PairingSecret {
    std::array<unsigned char, 32> bytes{};

    PairingSecret() = default;
    PairingSecret(const PairingSecret &) = default;
    PairingSecret &operator=(const PairingSecret &) = default;
    ~PairingSecret() { OPENSSL_cleanse(bytes.data(), bytes.size()); }
};

} // namespace hermes::ctl
