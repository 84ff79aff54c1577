"""How much sooner two workers of a Dask cluster answer than one."""
