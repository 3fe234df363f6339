#pragma once

#include "gui/desktop/widgets/ValueEditor.h"

#include <QCheckBox>

namespace hermes::desktop {

/// A tick for what is true or false. A value that is neither is kept until somebody ticks.
class CheckEditor : public ValueEditor {
    Q_OBJECT
public:
    explicit CheckEditor(const QJsonObject &schema, QWidget *parent = nullptr)
        : ValueEditor(parent)
        , box_(new QCheckBox) {
        hold(box_);
        connect(box_, &QCheckBox::clicked, this, [this](bool isTicked) {
            value_ = isTicked;
            Q_EMIT edited();
        });
        setValue(schema["default"]);
    }

    QJsonValue value() const override { return value_; }
    void setValue(const QJsonValue &value) override {
        value_ = value.isUndefined() ? QJsonValue(false) : value;
        box_->setChecked(value.toBool());
    }
    void showFaults(const QString &, const Faults &) override {}

private:
    QCheckBox *box_;
    QJsonValue value_;
};

} // namespace hermes::desktop
