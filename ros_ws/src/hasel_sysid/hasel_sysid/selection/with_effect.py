"""A model with one effect more."""

from hasel_sim.model import Model

from hasel_sysid.diagnosis import Diagnosis


def with_effect(model: Model, diagnosis: Diagnosis, effect: str) -> Model:
    """The model with an effect, at the values that its diagnosis fitted, else at a typical size.

    Raises ModelError where the effect does not go with the model's.
    """
    finding = diagnosis.finding(effect)
    extended = model.with_effects(finding.source or effect)
    fitted = finding.fit
    kind = next(e for e in extended.effects if e.id == effect)
    names = [f"{effect}.{p.name}" for p in kind.parameters]
    values = dict(zip(names, kind.typical().values(), strict=True))
    if fitted is not None:
        values = {name: fitted.model.values[name] for name in names}
    return extended.with_values(values)
