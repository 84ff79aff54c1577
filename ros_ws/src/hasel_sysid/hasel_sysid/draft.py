"""The low-fidelity model, a draft at half the cost, for finding one's way before the model itself decides."""

from hasel_sim.model import Model


def draft(model: Model) -> Model:
    """The model on seven tenths of the mesh density, with reduced quadrature and half the steps."""
    numerics = model.description.numerics
    return model.with_numerics(
        mesh_density=0.7 * numerics.mesh_density,
        quadrature_order=2,
        steps_per_second=0.5 * numerics.steps_per_second,
    )
