<story>
<p><emotion name="joy" weight="0.35"/>Lean a little closer, <gesture name="listen" weight="0.8"/>my ears are old; bells did that to them.
I was <gesture name="think" weight="0.6"/>nine and twenty when the town ordered the <gesture name="large"/><emphasis>greatest</emphasis> bell of the whole valley from me.
Every house gave <gesture name="explain" weight="0.7"/>what metal it had: a spoon, a buckle, a broken candlestick.
<emotion name="sadness" weight="0.45"/>And an old widow gave her <gesture name="small"/>thimble, <break time="300ms"/><prosody rate="90%">for she had nothing else.</prosody></p>

<p><emotion name="joy" weight="0.3"/>I laughed, and dropped it into my pocket instead of the fire.
<look at="fireplace"/>We cast her by night, with a fire <gesture name="open_arms"/>that lit the whole hill.<look at="visitor"/>
<emotion name="surprise" weight="0.4"/>In the morning I struck her for the first time, <break time="600ms"/><emotion name="fear" weight="0.45"/><prosody volume="soft" rate="88%">and she was <gesture name="shake_head" weight="0.6"/>dumb.</prosody>
Not a tone, not even a rattle; twenty hundredweight of bronze, <gesture name="shrug" weight="0.6"/>as silent as a pillow.
<gesture name="count_three"/>Three times I melted her down, <break time="200ms"/>and three times she kept <emphasis>silent</emphasis>.</p>

<p><emotion name="sadness" weight="0.5"/>Then, one night, I put my hand into my pocket, <break time="350ms"/><prosody rate="88%">and there was the <gesture name="small"/>thimble.</prosody>
<gesture name="sigh"/>Never in my life have I been so ashamed.
<emotion name="joy" weight="0.3"/>So I went to the widow and <gesture name="bow" weight="0.7"/>begged her pardon, and she threw it into the glowing metal with her own hand.</p>

<p><emotion name="joy" weight="0.9"/>And the bell <gesture name="wonder"/><emphasis level="strong">rang</emphasis>!
<gesture name="point_up"/>Seven villages heard her, and in the seventh, they say, <break time="250ms"/>a deaf man took off his hat.<gesture name="laugh" weight="0.7"/></p>

<p><emotion name="joy" weight="0.4"/><look at="visitor"/>Of what was left over I made <gesture name="heart"/>this little one here on my chain.
I wear it so that I never forget: <break time="300ms"/><prosody rate="86%">no gift is so <gesture name="small" weight="0.8"/>small that a bell could do without it.</prosody></p>
</story>
