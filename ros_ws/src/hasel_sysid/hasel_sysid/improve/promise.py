"""Whether a whole diagnosis of what an added effect leaves is worth its time."""

from hasel_sysid.diagnosis import Diagnosis
from hasel_sysid.diagnosis.significance import drops
from hasel_sysid.fit import FitResult
from hasel_sysid.projection import orthonormal


def most_promised(fit: FitResult, found: Diagnosis) -> float:
    """Largest share, 0 to 1, of what a fit leaves (sum of squares) that any other effect could take away.

    found: an earlier diagnosis of the same runs, whose signatures stand for what the effects would do now.
    """
    evaluation = fit.evaluation
    basis = orthonormal(evaluation.jacobian)
    present = {effect.id for effect in fit.model.effects}
    promised = [
        drops(signature.columns, basis, evaluation.residual)
        for effect, signature in found.signatures.items()
        if effect not in present
    ]
    return float(max(promised, default=0.0)) / evaluation.sum_of_squares
