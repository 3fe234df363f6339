#pragma once

#include "common/Result.h"

#include <QByteArray>
#include <QString>

namespace hermes {

/// A certificate and its private key, both PEM.
struct CertifiedKey {
    QByteArray certificate, key;
};

/// What a certificate is for: its subject.
struct CertificateSubject {
    QString name; ///< of a person, a program or a robot; 1 to 64 characters
    QString role; ///< of a client, as in Role.h; "daemon", or "authority"; empty: it has none
};

/// Error: it is not made of 1 to 64 letters, digits, or _ . @ -
Result<void> checkCertificateName(const QString &name);
/// A new authority: an ECDSA key (P-256) and a certificate that it has signed itself.
Result<CertifiedKey> makeAuthority(const QString &name, int days);
/// A new key, and a certificate that the authority has signed.
Result<CertifiedKey> issueCertificate(const CertifiedKey &authority, const CertificateSubject &subject,
                                      int days);
/// The text with its signature by the authority, as S/MIME.
Result<QByteArray> signText(const CertifiedKey &authority, const QByteArray &text);
/// Whether the authority, both PEM, has signed the certificate.
bool isSignedBy(const QByteArray &certificate, const QByteArray &authority);
/// Whether the key is that of the certificate.
bool belongTogether(const CertifiedKey &pair);

} // namespace hermes
