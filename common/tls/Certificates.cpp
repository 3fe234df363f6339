#include "common/tls/Certificates.h"

#include <QRegularExpression>
#include <memory>
#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/pkcs7.h>
#include <openssl/rand.h>
#include <openssl/x509v3.h>

namespace hermes {
namespace {

constexpr long secondsOfDay = 24 * 3600;
constexpr long clockTolerance_s = 24 * 3600; // a robot without a clock of its own begins in the past
constexpr int serialBytes = 8;
constexpr int longestCommonName = 64; // X.520 ub-common-name

template <auto Free>
struct Freeing {
    template <typename T>
    void operator()(T *object) const {
        Free(object);
    }
};
using Bio = std::unique_ptr<BIO, Freeing<BIO_free_all>>;
using Key = std::unique_ptr<EVP_PKEY, Freeing<EVP_PKEY_free>>;
using Certificate = std::unique_ptr<X509, Freeing<X509_free>>;

Error failed(const QString &what) {
    char reason[256] = "unknown";
    ERR_error_string_n(ERR_get_error(), reason, sizeof reason);
    ERR_clear_error();
    return {ErrorCode::InternalError, QString("%1: %2").arg(what, QString::fromLatin1(reason))};
}

QByteArray contentOf(const Bio &bio) {
    char *bytes = nullptr;
    const long size = BIO_get_mem_data(bio.get(), &bytes);
    return QByteArray(bytes, int(size));
}

Key readKey(const QByteArray &pem) {
    const Bio bio(BIO_new_mem_buf(pem.constData(), pem.size()));
    return Key(PEM_read_bio_PrivateKey(bio.get(), nullptr, nullptr, nullptr));
}

Certificate readCertificate(const QByteArray &pem) {
    const Bio bio(BIO_new_mem_buf(pem.constData(), pem.size()));
    return Certificate(PEM_read_bio_X509(bio.get(), nullptr, nullptr, nullptr));
}

bool addTo(X509_NAME *name, const char *field, const QString &text) {
    const QByteArray bytes = text.toUtf8();
    return X509_NAME_add_entry_by_txt(name, field, MBSTRING_UTF8,
                                      reinterpret_cast<const unsigned char *>(bytes.constData()),
                                      bytes.size(), -1, 0) == 1;
}

bool addExtension(X509 *certificate, X509 *issuer, int kind, const char *text) {
    X509V3_CTX context;
    X509V3_set_ctx(&context, issuer, certificate, nullptr, nullptr, 0);
    X509_EXTENSION *extension = X509V3_EXT_conf_nid(nullptr, &context, kind, text);
    const bool added = extension && X509_add_ext(certificate, extension, -1) == 1;
    X509_EXTENSION_free(extension);
    return added;
}

bool setSerial(X509 *certificate) {
    unsigned char bytes[serialBytes];
    if (RAND_bytes(bytes, sizeof bytes) != 1)
        return false;
    bytes[0] = (bytes[0] & 0x7f) | 0x40; // positive, and always of the same length
    BIGNUM *number = BN_bin2bn(bytes, sizeof bytes, nullptr);
    const bool set = number && BN_to_ASN1_INTEGER(number, X509_get_serialNumber(certificate));
    BN_free(number);
    return set;
}

bool describe(X509 *certificate, EVP_PKEY *key, const CertificateSubject &subject, int days) {
    X509_NAME *const name = X509_get_subject_name(certificate);
    return X509_set_version(certificate, X509_VERSION_3) == 1 && setSerial(certificate) &&
           X509_gmtime_adj(X509_getm_notBefore(certificate), -clockTolerance_s) &&
           X509_gmtime_adj(X509_getm_notAfter(certificate), days * secondsOfDay) &&
           X509_set_pubkey(certificate, key) == 1 && addTo(name, "CN", subject.name) &&
           (subject.role.isEmpty() || addTo(name, "OU", subject.role));
}

// Signed by the issuer; null: by its own key.
Result<CertifiedKey> make(const CertificateSubject &subject, int days, X509 *issuer, EVP_PKEY *issuerKey) {
    if (subject.name.isEmpty() || subject.name.size() > longestCommonName)
        return Error(ErrorCode::InvalidParams,
                     QString("the name of a certificate has 1 to %1 characters").arg(longestCommonName));
    const Key key(EVP_EC_gen("P-256"));
    const Certificate made(X509_new());
    if (!key || !made || !describe(made.get(), key.get(), subject, days))
        return failed("making a certificate");
    X509 *const by = issuer ? issuer : made.get();
    const bool isComplete = X509_set_issuer_name(made.get(), X509_get_subject_name(by)) == 1 &&
                            addExtension(made.get(), by, NID_basic_constraints,
                                         issuer ? "critical,CA:FALSE" : "critical,CA:TRUE,pathlen:0") &&
                            addExtension(made.get(), by, NID_key_usage,
                                         issuer ? "critical,digitalSignature"
                                                : "critical,keyCertSign,cRLSign,digitalSignature") &&
                            X509_sign(made.get(), issuerKey ? issuerKey : key.get(), EVP_sha256()) > 0;
    const Bio certificate(BIO_new(BIO_s_mem())), secret(BIO_new(BIO_s_mem()));
    if (!isComplete || PEM_write_bio_X509(certificate.get(), made.get()) != 1 ||
        PEM_write_bio_PrivateKey(secret.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr) != 1)
        return failed("signing a certificate");
    return CertifiedKey{contentOf(certificate), contentOf(secret)};
}

} // namespace

Result<void> checkCertificateName(const QString &name) {
    static const QRegularExpression plain("\\A[A-Za-z0-9_][A-Za-z0-9_.@-]{0,63}\\z");
    if (plain.match(name).hasMatch())
        return {};
    return Error(
        ErrorCode::InvalidParams,
        QString("the name \"%1\", expected 1 to 64 letters, digits, or one of _ . @ -").arg(name.left(80)));
}

Result<CertifiedKey> makeAuthority(const QString &name, int days) {
    return make({name, "authority"}, days, nullptr, nullptr);
}

Result<CertifiedKey> issueCertificate(const CertifiedKey &authority, const CertificateSubject &subject,
                                      int days) {
    const Certificate issuer = readCertificate(authority.certificate);
    const Key key = readKey(authority.key);
    if (!issuer || !key)
        return failed("reading the authority's certificate and key");
    return make(subject, days, issuer.get(), key.get());
}

Result<QByteArray> signText(const CertifiedKey &authority, const QByteArray &text) {
    const Certificate certificate = readCertificate(authority.certificate);
    const Key key = readKey(authority.key);
    const Bio in(BIO_new_mem_buf(text.constData(), text.size())), out(BIO_new(BIO_s_mem()));
    constexpr int flags = PKCS7_TEXT | PKCS7_DETACHED;
    const std::unique_ptr<PKCS7, Freeing<PKCS7_free>> made(
        certificate && key ? PKCS7_sign(certificate.get(), key.get(), nullptr, in.get(), flags) : nullptr);
    if (!made || BIO_reset(in.get()) != 1 || SMIME_write_PKCS7(out.get(), made.get(), in.get(), flags) != 1)
        return failed("signing a text");
    return contentOf(out);
}

bool isSignedBy(const QByteArray &certificate, const QByteArray &authority) {
    const Certificate signedOne = readCertificate(certificate), issuer = readCertificate(authority);
    const bool is = signedOne && issuer && X509_verify(signedOne.get(), X509_get0_pubkey(issuer.get())) == 1;
    ERR_clear_error();
    return is;
}

bool belongTogether(const CertifiedKey &pair) {
    const Certificate certificate = readCertificate(pair.certificate);
    const Key key = readKey(pair.key);
    const bool does = certificate && key && X509_check_private_key(certificate.get(), key.get()) == 1;
    ERR_clear_error();
    return does;
}

} // namespace hermes
