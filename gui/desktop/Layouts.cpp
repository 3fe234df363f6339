#include "gui/desktop/Layouts.h"

#include "common/files/SavedFile.h"
#include "gui/desktop/widgets/ForeignText.h"
#include "gui/desktop/widgets/Quantities.h"
#include "protocol/wire/JsonText.h"

#include <QCryptographicHash>
#include <QDir>
#include <QFileInfo>
#include <QJsonArray>
#include <QJsonDocument>
#include <QObject>
#include <QSettings>
#include <algorithm>

namespace hermes::desktop {
namespace {

constexpr qint64 largestFile = 1 << 20; // bytes; a window with all panels and a hundred plots has 20,000
constexpr int maxRobots = 200;

QString tr(const char *text) {
    return QObject::tr(text);
}

QByteArray checkOf(const Layouts::Layout &layout) {
    QCryptographicHash hash(QCryptographicHash::Sha256);
    hash.addData(layout.geometry);
    hash.addData(layout.state);
    return hash.result().toHex();
}

/// Where a symbolic link leads to, which stays one.
QString targetOf(QString file) {
    for (int links = 0; links < 40 && QFileInfo(file).isSymLink(); ++links)
        file = QFileInfo(file).symLinkTarget();
    return file;
}

/// Never empty.
QByteArray hashOf(const QByteArray &text) {
    return QCryptographicHash::hash(text, QCryptographicHash::Sha256);
}

QString nameOf(const QString &text) {
    return shortLine(text.trimmed(), Layouts::longestName);
}

QByteArray bytesOf(const QJsonValue &base64) {
    return QByteArray::fromBase64(base64.toString().toLatin1());
}

QJsonValue base64Of(const QByteArray &bytes) {
    return QString::fromLatin1(bytes.toBase64());
}

QMap<QString, QString> textsIn(const QJsonValue &object) {
    QMap<QString, QString> texts;
    const QJsonObject members = object.toObject();
    for (auto one = members.begin(); one != members.end(); ++one)
        texts[one.key()] = one.value().toString();
    return texts;
}

QJsonObject objectWith(const QMap<QString, QString> &texts) {
    QJsonObject object;
    for (auto one = texts.begin(); one != texts.end(); ++one)
        object[one.key()] = one.value();
    return object;
}

QJsonObject objectOfPairs(const QStringList &list) {
    QJsonObject object;
    for (int i = 0; i + 1 < list.size(); i += 2)
        object[list[i]] = list[i + 1];
    return object;
}

/// Earlier versions kept the same in an ini file. Empty: it is no such one. What QSettings would build from
/// "@Variant" was never kept.
QJsonObject fromIni(const QString &path, const QByteArray &text) {
    QSettings file(path, QSettings::IniFormat);
    const QStringList groups = file.childGroups();
    if (text.contains("@Variant(") || text.contains("@DateTime(") || file.status() != QSettings::NoError ||
        !(groups.contains("window") || groups.contains("layouts") || groups.contains("robots")))
        return {};
    QJsonArray layouts;
    const int count = qBound(0, file.beginReadArray("layouts"), Layouts::most);
    for (int i = 0; i < count; ++i) {
        file.setArrayIndex(i);
        layouts.append(QJsonObject{{"name", file.value("name").toString()},
                                   {"geometry", base64Of(file.value("geometry").toByteArray())},
                                   {"state", base64Of(file.value("state").toByteArray())},
                                   {"check", file.value("check").toString()},
                                   {"plots", objectOf(file.value("plots"))}});
    }
    file.endArray();
    QJsonObject kept;
    file.beginGroup("kept");
    for (const QString &key : file.allKeys())
        kept[key] = file.value(key).toString();
    file.endGroup();
    return {
        {"layout", file.value("window/layout").toString()},
        {"layouts", layouts},
        {"robots",
         QJsonObject{{"addresses", QJsonArray::fromStringList(file.value("robots/addresses").toStringList())},
                     {"names", objectOfPairs(file.value("robots/names").toStringList())},
                     {"chosen", file.value("robots/chosen").toString()}}},
        {"kept", kept}};
}

} // namespace

QString compactText(const QJsonValue &objectOrList) {
    return QString::fromUtf8(compactJson(objectOrList));
}

QJsonObject objectOf(const QVariant &text) {
    return QJsonDocument::fromJson(text.toString().toUtf8()).object();
}

Layouts::Layouts(const QString &file)
    : file_(targetOf(file)) {
    read();
    if (layouts_.empty())
        layouts_.push_back({tr("Usual"), {}});
    if (find(current_) == layouts_.end())
        current_ = layouts_.front().name;
}

QByteArray Layouts::fingerprintOf(const QString &file) {
    QFile content(file);
    return content.open(QIODevice::ReadOnly) ? hashOf(content.read(largestFile + 1)) : QByteArray();
}

void Layouts::read() {
    const QFileInfo info(file_), before(info.path() + '/' + info.completeBaseName() + ".ini");
    if (file_.isEmpty() || !(info.exists() || before.isFile()))
        return;
    QFile content(info.exists() ? file_ : before.filePath());
    const auto refuse = [&](const QString &why) {
        problem_ =
            tr("The layout of the window and the robots are not kept: %1 %2").arg(content.fileName(), why);
    };
    if (info.exists() && !info.isFile())
        return refuse(tr("is no file"));
    if (!content.open(QIODevice::ReadOnly))
        return refuse(tr("cannot be read: %1").arg(content.errorString()));
    const QByteArray text = content.read(largestFile + 1);
    if (info.exists())
        fingerprint_ = hashOf(text);
    QJsonObject kept = QJsonDocument::fromJson(text).object();
    if (kept.isEmpty() && text.size() <= largestFile)
        kept = fromIni(content.fileName(), text);
    if (text.size() > largestFile || (!text.trimmed().isEmpty() && !kept.contains("layouts")))
        return refuse(tr("is damaged, or was not written by this program. It is left as it is"));
    readLayouts(kept["layouts"].toArray());
    current_ = nameOf(kept["layout"].toString());
    const QJsonObject robots = kept["robots"].toObject();
    for (const QJsonValue &address : robots["addresses"].toArray())
        if (robots_.addresses.size() < maxRobots)
            robots_.addresses.append(address.toString());
    robots_.names = textsIn(robots["names"]);
    for (QString &name : robots_.names)
        name = nameOf(name);
    robots_.chosen = robots["chosen"].toString();
    values_ = textsIn(kept["kept"]);
}

// Qt may crash at a state that is not as it wrote it.
void Layouts::readLayouts(const QJsonArray &array) {
    for (const QJsonValue &one : array) {
        const QString name = nameOf(one["name"].toString());
        if (name.isEmpty() || find(name) != layouts_.end() || int(layouts_.size()) >= most)
            continue;
        Layout layout{bytesOf(one["geometry"]), bytesOf(one["state"]), one["plots"].toObject()};
        if (one["check"].toString().toLatin1() != checkOf(layout)) {
            layout.geometry = layout.state = {};
            damage_ = tr("The layout %1 is damaged: its panels are arranged as usual.").arg(name);
        }
        layouts_.push_back({name, layout});
    }
}

std::vector<Layouts::Named>::iterator Layouts::find(const QString &name) {
    return std::find_if(layouts_.begin(), layouts_.end(),
                        [&name](const Named &one) { return one.name == name; });
}

QStringList Layouts::names() const {
    QStringList names;
    for (const Named &one : layouts_)
        names.append(one.name);
    return names;
}

Layouts::Layout Layouts::layout() const {
    for (const Named &one : layouts_)
        if (one.name == current_)
            return one.layout;
    return {};
}

void Layouts::setLayout(const Layout &layout) {
    put(find(current_)->layout, layout);
}

Result<void> Layouts::choose(const QString &name) {
    if (find(name) == layouts_.end())
        return Error(ErrorCode::InvalidParams, tr("There is no layout %1.").arg(shortLine(name)));
    put(current_, name);
    return {};
}

Result<void> Layouts::saveAs(const QString &name) {
    const QString wanted = nameOf(name.left(longestName));
    if (wanted.isEmpty())
        return Error(ErrorCode::InvalidParams, tr("A layout needs a name."));
    if (find(wanted) != layouts_.end())
        return Error(ErrorCode::InvalidParams, tr("There is a layout %1 already.").arg(wanted));
    if (int(layouts_.size()) >= most)
        return Error(ErrorCode::InvalidParams, tr("There are %1 layouts: delete one first.").arg(most));
    layouts_.push_back({wanted, layout()});
    put(current_, wanted);
    return {};
}

Result<void> Layouts::remove() {
    if (layouts_.size() < 2)
        return Error(ErrorCode::InvalidParams, tr("The last layout stays."));
    layouts_.erase(find(current_));
    put(current_, layouts_.front().name);
    return {};
}

Result<void> Layouts::save() const {
    if (file_.isEmpty())
        return {};
    if (!problem_.isEmpty())
        return Error(ErrorCode::InputOutput, problem_);
    const QByteArray text = json();
    if (text.size() > largestFile)
        return Error(ErrorCode::InputOutput,
                     tr("The layout of the window and the robots are not kept any more: with buttons, plots "
                        "and names it has %1, and may have %2.")
                         .arg(sizeText(double(text.size())), sizeText(double(largestFile))));
    QDir().mkpath(QFileInfo(file_).absolutePath());
    const Result<void> saved = saveFile(file_, text);
    return saved ? saved
                 : Error(ErrorCode::InputOutput,
                         tr("The layout of the window and the robots could not be written: %1")
                             .arg(saved.error().message));
}

QByteArray Layouts::json() const {
    QJsonArray layouts;
    for (const Named &one : layouts_)
        layouts.append(QJsonObject{{"name", one.name},
                                   {"geometry", base64Of(one.layout.geometry)},
                                   {"state", base64Of(one.layout.state)},
                                   {"check", QString::fromLatin1(checkOf(one.layout))},
                                   {"plots", one.layout.plots}});
    const QJsonObject robots{{"addresses", QJsonArray::fromStringList(robots_.addresses)},
                             {"names", objectWith(robots_.names)},
                             {"chosen", robots_.chosen}};
    return QJsonDocument({{"layout", current_},
                          {"layouts", layouts},
                          {"robots", robots},
                          {"kept", objectWith(values_)}})
        .toJson();
}

} // namespace hermes::desktop
