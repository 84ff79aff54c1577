"""Simulations on a Dask cluster: who of its workers may take part, and what is done when one is lost."""
