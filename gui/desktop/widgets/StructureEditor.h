#pragma once

#include "gui/desktop/widgets/EditorFactory.h"

#include <QPointer>

namespace hermes::desktop {

/// The input for a list or an object: rows while there are not too many and they are not nested too deep, a
/// text else.
class StructureEditor : public ValueEditor {
    Q_OBJECT
public:
    static constexpr int deepest = 6;

    StructureEditor(const QJsonObject &schema, const EditorPlace &place, QWidget *parent = nullptr);
    ~StructureEditor() override;

    QJsonValue value() const override { return inner_->value(); }
    void setValue(const QJsonValue &value) override;
    void addFaults(const QString &path, Faults &faults) const override { inner_->addFaults(path, faults); }
    void showFaults(const QString &path, const Faults &faults) override { inner_->showFaults(path, faults); }
    bool placeNote(QWidget *note) override;
    QWidgetList focusOrder() const override { return inner_->focusOrder(); }

private:
    bool suitsRows(const QJsonValue &value) const;
    void put(ValueEditor *inner);
    void giveRoomBack();

    const QJsonObject schema_;
    const EditorPlace place_;
    const bool isList_;
    ValueEditor *inner_ = nullptr;
    bool hasRows_ = false;
    QPointer<QWidget> note_;
    int rows_ = 0, values_ = 0; // taken of the room
};

} // namespace hermes::desktop
