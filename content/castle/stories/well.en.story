<story>
<p><emotion name="joy" weight="0.35"/>Come <gesture name="beckon"/>closer, for this one is told best in a low voice.
<look at="well"/>When this castle was built, there was not a drop of <emphasis>water</emphasis> on the hill.<look at="visitor"/></p>

<p><emotion name="sadness" weight="0.5"/>A young mason called Matej dug for <gesture name="count_three"/>three summers,
and for three summers he found only dry stone.
<prosody rate="90%">The others laughed at him,</prosody> <break time="300ms"/>and then they stopped laughing,
<gesture name="shake_head" weight="0.6"/>and that was worse.</p>

<p><emotion name="surprise" weight="0.4"/>One evening a <emphasis>falcon</emphasis> settled on the edge of the shaft and would not leave.
<emotion name="joy" weight="0.3"/>Matej had half a loaf, so he shared it with the bird, <gesture name="small"/>crumb by crumb.
<break time="400ms"/><emotion name="surprise" weight="0.6"/>In the morning the falcon looked at him, folded its wings,
and <gesture name="point_near"/>flew straight down into the dark.</p>

<p><emotion name="neutral"/>What would <gesture name="shrug" weight="0.5"/>you have done?
<emotion name="fear" weight="0.5"/>He <emphasis>climbed</emphasis> after it, <prosody rate="92%">deeper than he had ever been</prosody>,
until the sky above him was no <gesture name="small"/>bigger than a coin.
And there he <gesture name="listen"/>heard it: <break time="600ms"/><prosody volume="soft" rate="85%">behind the rock, something was singing.</prosody></p>

<p><emotion name="joy" weight="0.85"/>He swung his hammer <gesture name="emphasize"/><emphasis level="strong">once</emphasis>, and the spring broke through!
It lifted him like a hand, <gesture name="wonder"/>all seventy metres, up into the light.</p>

<p><emotion name="joy" weight="0.4"/><point at="well"/>There it is, and since that day the well keeps every voice that calls into it.
<look at="visitor"/>Every <gesture name="explain" weight="0.7"/>song, every secret, <prosody rate="85%">every name.</prosody></p>

<p>So if you lean over it on a quiet evening, and <gesture name="hush"/>hold your breath, <break time="700ms"/>you may hear Matej laugh.</p>
</story>
