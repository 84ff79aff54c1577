"""Does a fit reach the likelihood of the truth, from its standard starts and from the true values?"""
