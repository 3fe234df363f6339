#include "common/settings/SettingsTable.h"

#include "common/settings/DottedPath.h"

#include <algorithm>

namespace hermes {

Field &SettingsTable::append(const QString &name, const void *member, const QString &description,
                             const QJsonObject &schema, const QJsonValue &initial,
                             const std::function<void(const QJsonValue &value)> &take) {
    Field field = Field::schema(name, description, schema).byDefault(initial).group(heading_);
    if (applies_ == Applies::OnRestart)
        field.appliesOnRestart();
    entries_.push_back({field, member, take});
    return entries_.back().field;
}

Field &SettingsTable::defineList(const QString &name, const QString &description,
                                 const QJsonObject &elementSchema) {
    return append(name, nullptr, description, {{"type", "array"}, {"items", elementSchema}}, QJsonArray(),
                  [](const QJsonValue &) {});
}

void SettingsTable::declareIn(Settings &settings) const {
    for (const Entry &entry : entries_)
        settings.declare(entry.field);
}

void SettingsTable::read(const QJsonObject &settings) {
    read_ = settings;
    for (const Entry &entry : entries_)
        entry.take(valueAt(settings, entry.field.name()));
}

QString SettingsTable::nameOf(const void *member) const {
    const auto found = std::find_if(entries_.begin(), entries_.end(),
                                    [member](const Entry &entry) { return entry.member == member; });
    Q_ASSERT(found != entries_.end());
    return found->field.name();
}

void SettingsTable::refuse(const void *member, const QString &expected) {
    const QString name = nameOf(member);
    violations_.push_back({name, valueAt(read_, name), expected});
}

} // namespace hermes
