"""What an earlier diagnosis of the same runs promises of its effects now that another one has been added."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from hasel_sim.effects.base import Effect

from hasel_sysid.diagnosis.signature import Signature
from hasel_sysid.diagnosis.significance import drops, orthonormal
from hasel_sysid.fit import FitResult

WORTH_A_LOOK = 0.05
"""Half the least share of the squared error for which an effect is added: signatures are only nearly right."""
_WORTH_A_TRY = 0.5 * WORTH_A_LOOK
_FEWEST = 3
"""The best few are tried in any case."""


def promised_shares(fit: FitResult, signatures: Mapping[str, Signature]) -> dict[str, float]:
    """Share, 0 to 1, of what a fit leaves (sum of squares) that every other effect could take away, by its id.

    signatures: what the effects looked like at an earlier fit, which stands for what they would do now.
    """
    evaluation = fit.evaluation
    basis = orthonormal(evaluation.jacobian)
    present = {effect.id for effect in fit.model.effects}
    return {
        effect: float(drops(seen.columns, basis, evaluation.residual)) / evaluation.sum_of_squares
        for effect, seen in signatures.items()
        if effect not in present
    }


def worth_trying(
    fit: FitResult, effects: Sequence[Effect], signatures: Mapping[str, Signature]
) -> list[Effect]:
    """The effects that could matter by their earlier signatures, and those that have none; all without any."""
    shares = promised_shares(fit, signatures)
    least = min(_WORTH_A_TRY, sorted(shares.values(), reverse=True)[:_FEWEST][-1]) if shares else 0.0
    return [effect for effect in effects if shares.get(effect.id, 1.0) >= least]


def carried_over(fit: FitResult, signature: Signature) -> Signature:
    """An earlier signature beside another fit: what this one's parameters cannot imitate of it."""
    basis = orthonormal(fit.evaluation.jacobian)
    return replace(signature, left=signature.change - basis @ (basis.T @ signature.change))
