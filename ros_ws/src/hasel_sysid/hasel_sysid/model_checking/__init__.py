"""What is asked of a model beyond how likely it is: is anything missing, does it describe every regime, is it a law?"""
